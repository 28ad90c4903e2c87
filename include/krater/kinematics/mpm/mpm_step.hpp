// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/mpm_step.hpp
/// One time step of the Material Point Method (theory 2-4, 11, 12):
///   particles_to_grid -> fold symmetry planes, tie levels -> momentum -> contact -> walls ->
///   mirror, tie -> grid_to_particles (+ stresses) -> migrate.
/// update usl: stress from v+ in the same gather. musl: velocities first, re-projected, stress from
/// the projection. usf: stress from v- first, of the motion of the step before. xpic(m): grid
/// velocity filtered m - 1 times (Hammerquist & Nairn 2017) before the gather.
#include <algorithm>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "krater/contact/boundary.hpp"
#include "krater/contact/contact.hpp"
#include "krater/core/stopwatch.hpp"
#include "krater/distribute/distribution.hpp"
#include "krater/kinematics/audit.hpp"
#include "krater/kinematics/energy_watch.hpp"
#include "krater/kinematics/kinematics.hpp"
#include "krater/kinematics/mpm/kernels.hpp"
#include "krater/kinematics/mpm/merge.hpp"
#include "krater/kinematics/mpm/migrate.hpp"
#include "krater/kinematics/mpm/node_loads.hpp"
#include "krater/kinematics/mpm/options.hpp"
#include "krater/kinematics/mpm/reference.hpp"
#include "krater/kinematics/mpm/reference_contact.hpp"
#include "krater/kinematics/mpm/ties.hpp"

namespace krater {

/// Phases of a step, for the account of its cost.
enum class Phase : std::size_t { scatter, nodes, contact, boundary, gather, migrate };
inline constexpr std::array<const char*, 6> phase_names{
    "scatter", "nodes", "contact", "boundary", "gather_and_stress", "migrate"};

/// Thrown by a step: where it broke. The points are left as they were when it was noticed.
struct StepFault {
  int patch;
  Fault fault;
};

class MpmStep final : public Kinematics {
 public:
  /// All references must outlive the step. `bodies[b]` belongs to patches with body == b. `plain`:
  /// the same kernels without the affine part, for projections of point velocities alone; on a
  /// fixed reference with it, for the present positions of nodes.
  /// `rigid`: bodies that move as a whole; their points are scattered, never gathered.
  struct Parts {
    BlockGrid& grid;
    BoundarySet& boundary;
    ContactSet& contact;
    RigidBodies& rigid;
    const Kernels& kernels;
    const Kernels& plain;
    const std::vector<BodyKernelData>& bodies;
    Audit& audit;
    NodeLoads& loads;
    Impulses& impulses;
    /// Contact on a fixed reference: kernels of the current configuration, and the shape of the
    /// scene.
    const Kernels* carriers = nullptr;
    KernelShape shape = KernelShape::quadratic_bspline;
    Distribution* ranks = nullptr;  ///< nullptr: all blocks are here
  };
  MpmStep(const MethodOptions& method, const Parts& parts);

  /// Halved, and halved again, while the grid's change of velocity would move material by more than
  /// 0.3 cells. Throws StepFault.
  double force(double dt) override;
  void meet(double dt) override;                              ///< throws EnergyError
  Standing move(double dt, const Standing& others) override;  ///< throws StepFault
  const TimeStepLimit& limit() const override { return limit_; }

  int set_count() const override { return static_cast<int>(grid_.patches().size()); }
  /// Inline: output asks for every component of every point.
  PointSet set(int s) const override {
    const Patch& patch = grid_.patches()[static_cast<std::size_t>(s)];
    return {patch.body, &patch.points};
  }
  PointStore& change(int s) override;

  /// Wall-clock seconds spent in a phase since construction.
  double seconds(Phase phase) const { return watch_.seconds(static_cast<std::size_t>(phase)); }
  /// Called in a step for each patch when its points have moved and are in the cache, by whatever
  /// thread: what leaves it is out, what will come to it is not there yet. Empty: nobody looks.
  void set_look(std::function<void(std::size_t patch)> look) { look_ = std::move(look); }
  /// Call after points were added or read from a checkpoint: links, memory, padding.
  void relink();
  /// The step taken last, after a restart [s].
  void set_last_step(double dt) { last_step_ = dt; }
  /// Smallest mass of a point, once for all [kg].
  void set_smallest_mass(double m) { node_settings_.smallest_mass = 1e-15 * m; }
  /// Or lighter ones may come.
  void expect_mass(double m) {
    double& least = node_settings_.smallest_mass;
    least = least > 0 ? std::min(least, 1e-15 * m) : 1e-15 * m;
  }
  /// How points of each body are made: what splitting goes by.
  void set_sizes(std::vector<PointSize> by_body) { sizes_ = std::move(by_body); }
  std::vector<PointSize>& sizes() { return sizes_; }
  const std::vector<PointSize>& sizes() const { return sizes_; }
  /// Another map of the levels: points move to their new blocks, and are split where these are
  /// finer.
  void regrid(BlockSet refined);
  /// How each body's points become one (kinematics/mpm/merge.hpp).
  void set_merge_plans(std::vector<MergePlan> by_body) { merge_plans_ = std::move(by_body); }
  /// Where blocks away from the edges of their level are crowded.
  void merge();
  /// Points that are too long for their cells, in halves (kinematics/mpm/stretch.hpp).
  void split_stretched();
  /// After a fault: points under way between blocks go where they belong.
  void deliver_leavers() { deliver(grid_, boundary_, bodies_, sizes_, 0, ranks_); }
  /// Speeds up to 1e-16 of this are rest: part of the scheme, whether blocks may be dormant or not.
  void set_reference_speed(double v) { node_settings_.flush_velocity = 1e-16 * v; }

 private:
  void particles_to_grid(const Kernels& kernels, const std::vector<BodyKernelData>& bodies,
                         double dt);
  /// Forces act over `force_share` dt; dt is halved while dv alone would move material too far.
  /// Returns 1/2 sum m |v+|^2 of the nodes and of rigid bodies [J].
  double momentum(double& dt, double force_share);
  struct Constraints {
    BoundaryWork walls;
    ContactWork contact;
    double change() const { return walls.change + contact.change; }
  };
  /// `projection`: the nodes of a second pass, whose impulses no rigid body receives.
  Constraints constrain(bool projection = false);
  ContactWork meet_bodies(bool projection);
  void begin_rigid(double dt, double& kinetic);
  void finish_rigid(double dt);
  void move_rigid(std::size_t patch, const SweepScratch& w);
  std::vector<int> rigid_losses() const;
  void book_loads(double dt);
  void book_impulses();
  void note_impulses();
  void note_put_back();
  void write_node_work();
  void book();
  std::vector<MomentumSettings> momentum_settings(double dt_force) const;
  ReproducibleSum node_kinetic() const;
  double greatest_change() const;
  double safe_share(double most, double dt_force) const;
  void shorten(double& dt, double share);
  void watch_energy() const;
  void name_limit(Patch& patch) const;
  void account_folds(double dt);
  bool may_sleep(GatherPart part) const;
  bool asleep(const NodeBlock& block) const;
  bool may_scatter_ahead(GatherPart part) const;
  void scatter_ahead(Patch& patch, const SweepSettings& s, const SweepScratch& w);
  void gather(std::size_t patch, GatherPart part, const SweepSettings& s, const SweepScratch& w);
  /// What follows the gather of a patch.
  struct AfterGather {
    bool moves, scatters;
  };
  void gather_and_collect(std::size_t patch, GatherPart part, const SweepSettings& s,
                          const AfterGather& then);
  void filter_velocity(std::array<double, 3>& impulse);
  void note_forces();
  void write_filtered_work();
  void relink_fluids();
  double* second_record(double* node);
  void sweep_fluids(PressurePart part, const SweepSettings& s);
  void sum_fluid_tiles(int first, int last);
  void fold_fluids(std::initializer_list<int> slots);
  void mirror_fluids(std::initializer_list<int> slots);
  template <class Work>
  void for_fluid_nodes(const Work& work);
  void collect_pressure(const SweepSettings& s);
  void add_pressure_force(const SweepSettings& s);
  void correct_dilatation(const SweepSettings& s);
  void grid_to_particles(GatherPart part, double dt);
  void combine_patches(GatherPart part);
  /// Of a patch: the pressure of its matter does not know its energy.
  bool feels_no_energy(std::size_t patch) const {
    return bodies_[static_cast<std::size_t>(grid_.patches()[patch].body)].heat_floor == nullptr;
  }
  void provide_memory();
  void throw_faults() const;
  bool faults_here() const;
  void migrate();
  void book_delivered(const Delivered& delivered);
  bool renew_references();
  void measure_gaps();
  CutCells cut_cells(int axis, int side, const GridGeometry& geometry) const;
  SweepSettings settings(double dt, int level = 0) const;
  std::vector<SweepSettings> all_settings(double dt) const;  ///< by level
  static std::size_t level_of(const Patch& patch) {
    return static_cast<std::size_t>(patch.key.level);
  }
  /// Momentum of a block that more than its tiles must be added to first.
  static bool waits(const NodeBlock& block) { return block.at_boundary || block.at_tie; }
  /// Node blocks that are not worth a second thread (for_each).
  std::size_t few_blocks() const { return grid_.geometry().dimension == 3 ? 8 : 64; }
  SweepScratch scratch();

  void strain_last_motion();
  void project_again(double dt);

  MethodOptions method_;
  BlockGrid& grid_;
  BoundarySet& boundary_;
  ContactSet& contact_;
  RigidBodies& rigid_;
  Distribution* ranks_;
  Ties ties_;
  const Kernels& kernels_;
  const Kernels& plain_;
  const std::vector<BodyKernelData>& bodies_;
  std::vector<PointColumns> columns_;  ///< of the bodies
  std::vector<PointSize> sizes_;
  std::vector<MergePlan> merge_plans_;
  std::vector<BodyKernelData> velocity_from_kept_;  ///< xpic: the scatter reads the kept velocities
  std::vector<BodyKernelData> position_as_velocity_;  ///< fixed reference: x and F as v and L
  void lap(Phase phase) { watch_.lap(static_cast<std::size_t>(phase)); }

  Audit& audit_;
  Standing others_;  ///< of what moved before in this step
  NodeLoads& loads_;
  Impulses& impulses_;
  std::unique_ptr<ReferenceContact> reference_contact_;  ///< null: nodes are where material is
  EnergyWatch energy_watch_;
  double grid_kinetic_ = 0;  ///< of the step under way, as are the next three
  Constraints constraints_;
  Triple external_impulse_{};
  bool loaded_;  ///< body forces or loads act
  Audit::StepHeat heat_;
  Stopwatch<phase_names.size()> watch_;
  MomentumSettings node_settings_;
  std::vector<std::size_t> waiting_blocks_;
  std::vector<std::size_t> stale_;  ///< patches that have not been scattered ahead
  TimeStepLimit limit_;
  double last_step_ = 0;  ///< usf: strains are those of the step before [s]
  AlignedBuffer zeros_, filtered_;
  AlignedBuffer pressure_nodes_;  ///< second records of all nodes (mpm/pressure_nodes.hpp)
  std::vector<std::size_t> fluid_patches_, fluid_blocks_;
  std::vector<Removed> removed_;
  struct ThreadMemory {
    AlignedBuffer halo, quadratics, pressure_halo, local, cells, pressures;
    std::vector<unsigned char> leavers;
    double scatter_seconds = 0;  ///< of the scatters ahead in one sweep
  };
  std::vector<ThreadMemory> memory_;
  std::function<void(std::size_t)> look_;
};

}  // namespace krater
