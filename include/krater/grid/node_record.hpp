// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file grid/node_record.hpp
/// A node's record: one cache line of eight numbers, read in two ways in the course of a step.
/// The vector kernels hold a whole record in a register; everyone else names its slots by these.

namespace krater {

inline constexpr int kNodeDoubles = 8;  ///< one node = one cache line = one vector register

/// After the scatter: sums over points.
namespace summed {
inline constexpr int mass = 0;      ///< [kg]
inline constexpr int momentum = 1;  ///< 1 to 3 [kg m/s]
inline constexpr int force = 4;     ///< 4 to 6 [N]
inline constexpr int volume = 7;    ///< [m^3]
}  // namespace summed

/// After the momentum update.
namespace moved {
inline constexpr int velocity = 0;  ///< v+, 0 to 2 [m/s]
inline constexpr int mass = 3;      ///< [kg]
inline constexpr int change = 4;    ///< v+ - v-, 4 to 6 [m/s]
inline constexpr int volume = 7;    ///< [m^3], until contact and walls have read it
inline constexpr int work = 7;      ///< then k, the work and heat of the step [J/kg]
}  // namespace moved

}  // namespace krater
