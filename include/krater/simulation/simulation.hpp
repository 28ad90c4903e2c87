// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/simulation.hpp
/// A scene assembled and stepped: bodies, grid, boundaries, kernels of the best instruction set,
/// time-step control. Knows nothing of files; what it hands out are the plain structs of
/// output/results.hpp.
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "krater/kinematics/clock.hpp"
#include "krater/kinematics/loads.hpp"
#include "krater/kinematics/mesh/mesh_step.hpp"
#include "krater/kinematics/mpm/kernel_levels.hpp"
#include "krater/kinematics/mpm/mpm_step.hpp"
#include "krater/kinematics/sph/sph_step.hpp"
#include "krater/output/results.hpp"
#include "krater/points/place.hpp"
#include "krater/simulation/body.hpp"
#include "krater/simulation/detonation.hpp"
#include "krater/simulation/refinement.hpp"
#include "krater/simulation/torn_points.hpp"
#include "krater/simulation/totals.hpp"
#include "krater/simulation/warnings.hpp"

namespace krater {

/// Points side by side, each with the level of the cells about it.
struct BroughtPoints {
  std::vector<PointPlace> places;
  std::vector<int> levels;
};

/// What a fault means, in words.
const char* text_of(FaultKind kind);

/// Throws InputError where time.first_step or time.min_step exceed the stable step [s].
void require_steps(const TimeOptions& time, double stable);

class Simulation {
 public:
  /// The scene must outlive the simulation. Throws InputError.
  explicit Simulation(const Scene& scene, IsaLevel level = best_isa_level());
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  ~Simulation();  ///< of the first of several ranks: the others may go

  const Scene& scene() const { return scene_; }
  double time() const { return clock_.time(); }
  std::int64_t steps() const { return clock_.steps(); }
  double dt() const { return clock_.dt(); }            ///< of the last step [s]
  double dt_free() const { return clock_.free_dt(); }  ///< before it was cut to an output time [s]
  /// What the greatest speeds of the start allow; the first steps grow towards it [s].
  double expected_dt() const { return clock_.expected_dt(); }
  bool done() const { return time() >= scene_.time.end; }
  /// Take one step, not past `until` [s]. Throws NumericalError.
  void step(double until);
  /// A survey will be asked for after the first step that ends at `time` or later [s]: it costs
  /// less then.
  void expect_survey(double time) { survey_due_ = time; }
  /// Where several ranks compute the scene (distribute/distribution.hpp), each has its share of the
  /// points from the start; here they begin together, when all are ready. Throws InputError, on all
  /// of them. All that follows is for the first to call, but follow().
  void distribute();
  /// The other ranks do what the first one does, until it is gone. `checkpoint`: where it restores
  /// one.
  void follow(const std::function<Checkpoint()>& checkpoint);
  /// All points come to the first rank, to be read there until the next step.
  void assemble();
  /// They are there: one rank has all, or they were assembled.
  bool has_all_points() const { return !ranks_ || assembled_; }
  /// Points of a body in the order of their ids, from the row `first` on, from whatever rank. Until
  /// the next call.
  BroughtPoints bring(int body, std::size_t first, std::size_t count) const;
  const Distribution* distribution() const { return ranks_.get(); }  ///< null: one rank
  bool broken() const { return broken_; }  ///< a step failed half-way: the state is for a look only
  double stable_step() const { return clock_.stable_step(limit_.rate); }  ///< of the next step [s]
  const char* limiter() const;         ///< what limits the time step
  std::string describe_limit() const;  ///< the same with the point and what it has
  int limiter_kind() const {
    return limit_.kind;
  }  ///< 0 wave speed, 1 material velocity, 2 volume change

  IsaLevel isa_level() const { return level_; }
  std::size_t point_count() const;
  std::size_t point_count(int body) const;
  std::size_t block_count() const { return grid_.patches().size(); }
  double bytes_per_point() const;
  const std::vector<std::unique_ptr<Body>>& bodies() const { return bodies_; }
  const BlockGrid& grid() const { return grid_; }
  BlockGrid& grid() { return grid_; }
  const RigidBodies& rigid() const { return rigid_; }
  const MpmStep& stepper() const { return *step_; }
  const Audit& audit() const { return audit_; }
  /// On bodies together by a partner that a measure of the scene names, so far [N s].
  Triple impulse(const std::vector<int>& bodies, Partner by) const;
  /// Throws NumericalError when more energy is unphysical than the scene allows. `last`: the run
  /// ends.
  void judge_energy(bool last);
  /// How the elements are, for a row of the history: what is said of it too.
  void look_at_elements();
  /// Which points have lost each other (simulation/torn_points.hpp), for a row of the history;
  /// nothing unless the scene asks.
  void look_for_torn_points();
  const TornPoints& torn_points() const { return torn_; }  ///< as last looked for
  bool makes_points() const;                               ///< while it runs, by splitting
  /// Whether they lie on themselves, for a frame: it takes longer.
  void look_for_overlap();
  const MeshHealth& elements() const { return health_; }  ///< as last looked at
  const Warnings& warnings() const { return warnings_; }
  Warnings& warnings() { return warnings_; }
  const GridGeometry& geometry() const { return geometry_; }
  /// Of all sets, in their order.
  std::vector<PointSurvey> survey() const;
  std::vector<Totals> totals_by_body() const { return totals_by_body(survey()); }
  std::vector<Totals> totals_by_body(const std::vector<PointSurvey>& sets) const;
  Totals totals() const;  ///< of all bodies
  Totals totals(int body) const { return totals_by_body()[static_cast<std::size_t>(body)]; }

  /// All points, in sets of one body; the order is part of the state. First elements, then
  /// particles, by body.
  int set_count() const { return first_points() + step_->set_count(); }
  PointSet set(int s) const {
    if (s >= first_points()) return step_->set(s - first_points());
    return s < mesh_sets() ? mesh_->set(s) : sph_->set(s - mesh_sets());
  }
  /// The cells about the points of a set.
  const GridGeometry& geometry_of(int s) const {
    return s < first_points()
               ? geometry_
               : grid_.geometry(
                     grid_.patches()[static_cast<std::size_t>(s - first_points())].key.level);
  }
  const MeshStep* mesh() const { return mesh_.get(); }  ///< null: no body has elements
  bool is_mesh_set(int s) const { return s < mesh_sets(); }
  bool is_mesh(int body) const {
    return bodies_[static_cast<std::size_t>(body)]->options().mesh.has_value();
  }
  const SphStep* sph() const { return sph_.get(); }  ///< null: no body has particles
  /// (set, index in it) of every point of a body in order of its id.
  std::vector<std::pair<int, int>> points_by_id(int body) const;
  /// Component at a slot (Body::slot). Inline, for output asks for every component of every point.
  double value(int s, int point, int slot) const { return set(s).points->at(kLanes * slot, point); }
  void set_value(int set, int point, int slot, double x);
  /// After set_value: what it changed of the energy is work from outside.
  void book_change();

  /// The points as they are when they are read: write it before the next step.
  Checkpoint save() const;
  void restore(
      const Checkpoint& checkpoint);  ///< throws InputError when it belongs to another scene

 private:
  void plan_ranks();
  void deal_lattices();
  void deal_saved(const Checkpoint& checkpoint);
  void start();  ///< what needs all points; the ranks do it together
  void restore_together(const std::function<Checkpoint()>& checkpoint);
  void restore_here(const Checkpoint& checkpoint);
  void advance(double until);
  void fit_points();
  void assemble_together();
  void release();
  /// After a fault of points, which all ranks know of: text of the first, which has them all.
  [[noreturn]] void fail_fault(const StepFault& fault);
  int mesh_sets() const { return mesh_ ? mesh_->set_count() : 0; }
  int first_points() const { return mesh_sets() + (sph_ ? sph_->set_count() : 0); }
  bool is_sph(int body) const {
    return bodies_[static_cast<std::size_t>(body)]->options().sph.has_value();
  }
  PointStore& change(int s) {
    if (s >= first_points()) return step_->change(s - first_points());
    return s < mesh_sets() ? mesh_->change(s) : sph_->change(s - mesh_sets());
  }
  /// What moves bodies: elements first, then particles, for material points book what all hold.
  void find_movers();
  void find_limit();
  void place_particles();
  void let_bodies_meet();
  Totals totals_of_particles(int s) const;
  void restore_particles(int body, const Checkpoint& checkpoint);
  void place_meshes();
  Totals totals_of_mesh(int s) const;
  std::vector<int> sets_of(int body) const;
  int mesh_set(int body) const;
  void adopt_converted();
  void resize_mesh(int body, const Checkpoint& checkpoint, std::uint64_t points);
  void restore_mesh(int body, const Checkpoint& checkpoint);
  std::unique_ptr<NodeLoads> make_loads();
  PointSurvey survey_of_set(int s) const;
  PointSurvey survey_of_patch(std::size_t patch) const;
  const PointSurvey* seen_in_step(std::size_t patch) const;
  void look_in_step(double dt);
  int count_of(int s) const;  ///< points of a set, on whatever rank
  void copy_column(int body, int slot, double* to) const;
  void column_together(int body, int slot, double* to) const;
  void open_slabs_together(int body) const;
  std::vector<double> records_of_slab(std::size_t first, std::size_t end) const;
  void slab_together(std::size_t first, std::size_t end) const;
  void survey_together() const;
  void save_levels(Checkpoint& out) const;
  void restore_levels(const Checkpoint& checkpoint);
  void find_levels();
  void place_points();
  bool may_split(const Body& body) const;
  double place_body(int body);  ///< smallest mass of a point that it may come to [kg]
  int coarsest_level(int body);
  void add_rigid_bodies();
  void place_rigid_bodies();
  void save_body(int body, Checkpoint& out) const;
  void restore_body(int body, const Checkpoint& checkpoint);
  void restore_columns(const CheckpointBlob& points, const Body& body,
                       const std::vector<int>& sets);
  void choose_first_step();
  Acceleration body_force() const;  ///< of the scene; empty: none
  Triple apply_body_force();        ///< on the points [N]
  void watch_impulses();
  std::string impulse_name(const ImpulsePair& pair) const;
  std::vector<FieldId> fields_of(const std::vector<int>& bodies) const;
  bool walls_act_on_points() const;
  std::array<double, 3> apply_point_walls(double dt);  ///< force on the points [N]
  double next_step(double until);
  std::string limiting_field(int set, int point) const;
  std::string describe_hottest() const;
  [[noreturn]] void fail_energy(const EnergyError& e);
  std::string describe_fault(int set, const Fault& fault) const;
  std::string describe_point(int set, int point) const;
  double energy_per_mass(int set, int point) const;

  const Scene& scene_;
  IsaLevel level_;
  GridGeometry geometry_;
  std::vector<std::unique_ptr<Body>> bodies_;
  std::vector<BodyKernelData> kernel_data_;
  BlockGrid grid_;
  std::unique_ptr<Refinement> refinement_;  ///< null: one level
  BoundarySet boundary_;
  ContactSet contact_;
  RigidBodies rigid_;
  EnergyWatch energy_watch_;
  Detonation detonation_;
  std::unique_ptr<Kernels> kernels_, plain_kernels_;
  std::unique_ptr<Kernels> carrier_kernels_;  ///< contact on a fixed reference
  Audit audit_;
  Impulses impulses_;
  std::unique_ptr<NodeLoads> loads_;
  std::unique_ptr<Distribution> ranks_;  ///< null: one rank has all
  struct Slabs;  ///< points of one body by their ids, where ranks write together
  mutable std::unique_ptr<Slabs> slabs_;
  mutable std::vector<PointSurvey> survey_;  ///< where points are elsewhere ...
  mutable std::int64_t surveyed_ = -1;       ///< ... and of which step
  /// What a patch was found to be in the sweep of a step.
  struct SeenPatch {
    BlockKey key;
    int body;
    std::int64_t step;  ///< -1: in none
    PointSurvey found;
  };
  std::vector<SeenPatch> seen_;  ///< of the last step that a survey was to follow
  double survey_due_ = std::numeric_limits<double>::infinity();  ///< [s]
  bool together_ = false;                                        ///< the ranks have begun
  bool assembled_ = false;  ///< points of other ranks are on the first, too
  std::unique_ptr<MpmStep> step_;
  std::unique_ptr<MeshKernels> mesh_kernels_;
  std::unique_ptr<MeshStep> mesh_;
  std::unique_ptr<Encounter> encounter_;  ///< null: only bodies of points meet
  std::unique_ptr<SphStep> sph_;
  std::vector<Kinematics*> movers_;
  MeshHealth health_;
  TornPoints torn_;
  StepClock clock_;
  TimeStepLimit limit_;  ///< of the next step
  bool broken_ = false;
  Warnings warnings_;
};

}  // namespace krater
