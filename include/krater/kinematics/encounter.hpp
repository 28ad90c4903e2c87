// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/encounter.hpp
/// Contact in passes: what a body receives is smoothed over it, so that some of the approach is
/// left, and bodies exchange again. Where two encounters share bodies their passes take turns, and
/// their losses are one.
#include <array>
#include <vector>

#include "krater/contact/options.hpp"
#include "krater/kinematics/kinematics.hpp"

namespace krater {

/// An axis-aligned box around places; as made, around none.
struct SpaceBox {
  Triple low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void hold(const Triple& x) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = low[a] < x[a] ? low[a] : x[a];
      high[a] = high[a] > x[a] ? high[a] : x[a];
    }
  }
  /// Closer than `within` along every axis.
  bool meets(const SpaceBox& other, double within) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (low[a] > other.high[a] + within || other.low[a] > high[a] + within) return false;
    return true;
  }
};
struct BodyBox {
  int body;  ///< of the scene
  SpaceBox box;
};

/// What contact took from motion [J], and sum m |dv|^2 of what it pushed, by which it is its heat.
struct EncounterLoss {
  double taken = 0, pushed = 0;
  double share() const { return pushed > 0 ? taken / pushed : 0.0; }
};

class PassingEncounter : public Encounter {
 public:
  virtual std::vector<BodyBox> boxes() const = 0;  ///< of its bodies
  virtual void begin() = 0;                        ///< who meets whom, and where
  virtual void pass(double dt) = 0;
  virtual void end() = 0;
  virtual EncounterLoss loss() const = 0;  ///< of its own bodies, when every velocity is final
  /// Heat of its bodies; `all`: of everything that takes part.
  virtual Standing warm(const EncounterLoss& all) = 0;
};

}  // namespace krater
