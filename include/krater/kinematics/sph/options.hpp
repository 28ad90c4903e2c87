// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sph/options.hpp
/// What a scene says of a body of particles.

namespace krater {

enum class SphKernel { cubic_spline, wendland_c2, quadratic };
/// Whether gradients are corrected to be exact for linear fields (kinematics/sph/correction.hpp).
enum class SphCorrection { linear, none };
/// Where weights and neighbours are those of: the places now, those at the start, or those where
/// the body was last strained as far as it may be.
enum class SphReference { current, initial, adaptive };

struct SphOptions {
  double spacing = 0;      ///< of the particles at the start, dx [m]
  double smoothing = 1.2;  ///< h/dx
  SphKernel kernel = SphKernel::quadratic;
  SphCorrection correction = SphCorrection::linear;
  SphReference reference = SphReference::current;
  double refresh_strain = 0.3;   ///< adaptive: greatest Green-Lagrange strain on one reference
  double zero_energy = 1;        ///< z of what holds modes that gradients do not see, 0: none
  double artificial_stress = 0;  ///< eps, of the tension of close pairs, on `current`; 0: none
  double length() const { return smoothing * spacing; }  ///< h [m]
};

}  // namespace krater
