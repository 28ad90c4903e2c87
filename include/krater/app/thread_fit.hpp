// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/thread_fit.hpp
/// As many threads as a scene keeps busy, where the user asks for no number. A patch is some 20 to
/// 30 us of work a step, and each of the loops of a step wakes all threads, 3 us and more: beyond
/// half as many threads as patches at work a step takes longer, not shorter. Results do not depend
/// on it.
#include "krater/simulation/simulation.hpp"

namespace krater {

class ThreadFit {
 public:
  /// `asked` threads are what the user gets; 0: as many as fit, at most those there are now.
  explicit ThreadFit(int asked);
  /// Before a step. Patches sleep, wake and are made; a change of number by less than two is not
  /// worth the new threads.
  void look(const Simulation& sim);

 private:
  int most_;  ///< 1: nothing to choose
  int calls_ = 0;
};

}  // namespace krater
