// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sph/sph_kernels.hpp
/// The sweeps over particles, compiled for every instruction-set level, dimension, weight and
/// reference, and the plain data that they work on. Particles lie in lane groups of 8
/// (points/store.hpp). What is gathered from neighbours lies in records of its own, one after the
/// other, particles first and then their mirror images:
///   motion  [x y z  V  vx vy vz  0]     places and volumes of the reference
///   load    [x y z V | A | v | D | Z | x now]   A = S K, 4 or 9 components (row-major),
///           D = sym L, off the diagonal twice, Z = rho c, x now where the reference is another:
///           LoadRecord
/// and what a group has beside its columns in arrays of `groups` records:
///   correction [6][8]   power [8]   force [3][8]   remembered [2][8]: G and tr D of the last step
///   held [4][8]: of the forces, what holds zero-energy modes, and what it takes from motion [W]
///   reference [3][8], reference_density [8]: places and densities there   deformation [9][8]: F
#include <cstdint>

#include "krater/core/isa_level.hpp"
#include "krater/kinematics/sph/options.hpp"
#include "krater/kinematics/sweep_result.hpp"
#include "krater/materials/stage.hpp"

namespace krater {

/// Offsets in the record of a group; -1: absent.
struct SphColumns {
  int id, position, velocity, mass, density, stress, pressure, viscous, energy, sound_speed;
  int share;  ///< marks of loads
  int local_gradient, local_rate, local_shear;
  int stride, local_stride;
};

/// The neighbours of a group: `count` rows of 8 indices, lane by lane.
struct NeighbourRows {
  const std::int32_t* rows = nullptr;
  int count = 0;
};

inline constexpr int kMotion = 8;  ///< doubles of a record of motion

/// Where things are in a record of load.
struct LoadRecord {
  int A, v, D, Z, now, size;
};
constexpr LoadRecord load_record(int dim) {
  const int v = 4 + dim * dim, D = v + dim, Z = D + dim * (dim + 1) / 2, now = Z + 1;
  return {4, v, D, Z, now, (now + dim + 7) / 8 * 8};
}

struct SphData {
  double* particles;
  int count, groups;
  const NeighbourRows* neighbours;
  double *motion, *load;
  double *correction, *power, *force, *held, *remembered, *reference, *reference_density,
      *deformation;
  const double* changes;  ///< of velocity in the step and heat per mass, 4 for each particle
  SphColumns columns;
  const Stage* const* stages;
  int stage_count;
  double h;  ///< [m]
  double q_lin, q_quad, zero_energy;
  double artificial_stress;
  double spacing;  ///< at the start [m]
  bool corrects;
};

struct SphScratch {
  double* local;   ///< kSphGroups records
  double* length;  ///< 8 each
  const double* zeros;
};
inline constexpr int kSphGroups = 8;  ///< groups that a stage works on at once

struct SphResult : SweepResult {
  double held = 0;     ///< work against zero-energy modes [J]
  double stretch = 0;  ///< greatest component of |F^T F - 1|
  int flat = 0;        ///< particles whose correction is not the full one
};

class SphKernels {
 public:
  SphKernels() = default;
  SphKernels(const SphKernels&) = delete;
  SphKernels& operator=(const SphKernels&) = delete;
  virtual ~SphKernels();
  /// Records of motion from the columns; with the velocities of the end of the step where `ends`.
  virtual void place(const SphData& data, bool ends, int first, int last) const = 0;
  /// K, sigma : L of the velocities now, records of load, and what the state allows of a step.
  virtual void correct(const SphData& data, int first, int last, SphResult& out) const = 0;
  virtual void forces(const SphData& data, int first, int last) const = 0;
  /// A in the records of load is that of a stress of one.
  virtual void show_unit(const SphData& data, int first, int last) const = 0;
  /// Work, strain and stages of a step dt; places and velocities at its end.
  virtual void strain(const SphData& data, const SphScratch& scratch, double dt, int first,
                      int last, SphResult& out) const = 0;
};

struct SphChoice {
  int dimension = 3;
  SphKernel kernel = SphKernel::cubic_spline;
  SphReference reference = SphReference::current;
};
struct SphKernelFactory {
  SphKernels* (*make)(const SphChoice& choice);  ///< ownership passes to the caller
};
const SphKernelFactory& sph_kernel_factory(IsaLevel level);
const SphKernelFactory* sph_kernel_factory_isa_portable();
const SphKernelFactory* sph_kernel_factory_isa_v3();
const SphKernelFactory* sph_kernel_factory_isa_v4();

}  // namespace krater
