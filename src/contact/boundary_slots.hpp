// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file
/// Where the sides of the domain find what they change in a node record.

namespace krater {

inline constexpr int kMass = 0, kMomentum = 1, kForce = 4, kVolume = 7;  // after the scatter
inline constexpr int kVelocity = 0, kNodeMass = 3, kChange = 4;  // after the momentum update

}  // namespace krater
