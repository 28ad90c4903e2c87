// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file
/// How several ranks begin and end a run together: the first one runs it, the others follow.
#include <string>

#include "krater/scene/scene.hpp"

namespace krater {

/// Ranks go on together or not at all: one that cannot begin says so by not coming to agree(). What
/// keeps it is heard where the first rank has nothing to say itself.
class Readiness {
 public:
  Readiness() = default;
  Readiness(const Readiness&) = delete;
  Readiness& operator=(const Readiness&) = delete;
  ~Readiness();
  void agree();  ///< throws InputError where another rank could not begin

 private:
  bool agreed_ = false;
};

/// A rank but the first: it computes, and neither reads nor writes results. `restart`: a
/// checkpoint, or empty. Returns the exit code.
int follow(const std::string& restart, const Scene& scene, Readiness& ready);

}  // namespace krater
