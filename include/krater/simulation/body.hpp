// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/body.hpp
/// A body put together from the scene: the stages its material calls for, the columns they ask for,
/// its points.
#include <memory>
#include <string>
#include <vector>

#include "krater/contact/rigid.hpp"
#include "krater/geometry/seeds/lattice.hpp"
#include "krater/kinematics/mpm/kernels.hpp"
#include "krater/materials/assembly.hpp"
#include "krater/points/layout.hpp"
#include "krater/scene/scene.hpp"

namespace krater {

class Body {
 public:
  /// Makes stages and columns; no points yet. Throws InputError.
  Body(const Scene& scene, int index, const StageFactory& factory);

  const std::string& name() const { return options_->name; }
  const BodyOptions& options() const { return *options_; }
  const MaterialOptions& material() const { return *material_; }
  const Layout& layout() const { return layout_; }
  const std::vector<NamedStage>& stages() const { return stages_; }
  const FillReport& fill_report() const { return fill_; }
  const VolumeMoments& seed_moments() const { return seed_moments_; }
  /// Where a twentieth of the mass is thinner [m], see geometry/seeds/thickness.hpp.
  double thickness() const { return thickness_; }
  double seed_cell() const { return seed_cell_; }  ///< cells of its lattice: seeds() [m]
  /// Throws InputError when a fifth of the mass is where it is no thicker than a cell.
  void require_thickness(double cell) const;
  double q_lin() const { return q_lin_; }
  double initial_sound_speed() const { return sound_speed_; }  ///< longitudinal, undeformed [m/s]
  /// What a first step reckons with, viscosity and free corners included, from a bulk sound speed
  /// (or that of the undeformed material, if it is greater) [m/s].
  double signal_speed(double bulk = 0) const;
  bool is_fluid() const;  ///< or a soft solid, G below 1 % of K
  /// The step integrates the pressure on the grid (mpm/grid_pressure.hpp).
  bool pressure_on_grid(const Scene& scene) const;
  bool degrades() const { return degrades_; }  ///< damage weakens the stress, s = (1 - phi) s~
  BodyKernelData kernel_data() const;

  /// Seeds of the body inside the domain; throws InputError when there are none, or when the body
  /// is no more than a cell thick.
  std::vector<SeedPoint> seeds(const Scene& scene, int level = 0);
  /// The same without a look at what they are like. Throws where there are none.
  std::vector<SeedPoint> lattice(const Scene& scene, int level);
  /// Offset in a point's record (doubles), -1 if the column does not exist.
  int slot(const FieldInfo& field, int component = 0) const;

 private:
  void examine_thickness(const Scene& scene, const std::vector<SeedPoint>& seeds, double cell);
  void add_stages(const StageFactory& factory);

  const BodyOptions* options_;
  const MaterialOptions* material_;
  Layout layout_;
  std::vector<NamedStage> stages_;
  std::unique_ptr<const Stage> heat_floor_;
  std::vector<const Stage*> stage_pointers_;
  FillReport fill_;
  VolumeMoments seed_moments_;
  double thickness_ = 0, thin_ = 0, seed_cell_ = 0;
  bool degrades_ = false;
  double q_lin_ = 0, q_quad_ = 0, sound_speed_ = 0;
};

/// How a rigid body of the scene may move: planes of symmetry that cut it, and the axis, hold it.
RigidOptions rigid_options(const Scene& scene, const Body& body, int index);
/// "moves along x, z; turns about y", for `krater check`.
std::string describe_motion(Frame frame, const RigidOptions& options);

/// The loads on a body's faces, in the order of its marks.
std::vector<int> loads_of(const Scene& scene, int body);
/// How far a point or particle of the body belongs to the face of a load, 0 to 1.
double face_share(const Scene& scene, const FaceLoad& load, const BodyOptions& body,
                  const Triple& x);

/// The domain of a scene as a box in grid axes.
Box domain_box(const Scene& scene);
/// Some side of the domain is a unilateral wall.
bool has_wall(const Scene& scene);

}  // namespace krater
