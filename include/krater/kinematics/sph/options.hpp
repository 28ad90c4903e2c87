// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sph/options.hpp
/// What a scene says of a body of particles.

namespace krater {

enum class SphKernel { cubic_spline, wendland_c2 };
/// Whether gradients are corrected to be exact for linear fields (kinematics/sph/correction.hpp).
enum class SphCorrection { linear, none };
/// Where weights and neighbours are those of: the places now, or those at the start.
enum class SphReference { current, initial };

struct SphOptions {
  double spacing = 0;      ///< of the particles at the start, dx [m]
  double smoothing = 1.2;  ///< h/dx
  SphKernel kernel = SphKernel::cubic_spline;
  SphCorrection correction = SphCorrection::linear;
  SphReference reference = SphReference::current;
  double zero_energy = 0.1;  ///< coefficient of what holds modes that gradients do not see, 0: none
  double length() const { return smoothing * spacing; }  ///< h [m]
};

}  // namespace krater
