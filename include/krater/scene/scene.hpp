// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/scene.hpp
/// A scene as plain data: every key checked, every value in SI, every default filled in. Absence of
/// an optional block means: that effect is not simulated. `where` strings ("taylor.yaml:12:
/// bodies.rod") serve later errors.
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "krater/contact/options.hpp"
#include "krater/geometry/frame.hpp"
#include "krater/geometry/lighting.hpp"
#include "krater/geometry/seeds/lattice.hpp"
#include "krater/geometry/solids/solid.hpp"
#include "krater/kinematics/load_options.hpp"
#include "krater/kinematics/mesh/options.hpp"
#include "krater/kinematics/mpm/options.hpp"
#include "krater/kinematics/sph/options.hpp"
#include "krater/materials/stage.hpp"
#include "krater/scene/gauges.hpp"
#include "krater/scene/measures.hpp"
#include "krater/scene/outcomes.hpp"

namespace krater {

/// Where cells are halved, once per level: in a region, around a body, or where a field is large.
struct RefineOptions {
  std::string where;
  int level = 1;
  std::optional<Box> box;               ///< along the grid axes, or ...
  std::shared_ptr<const Solid> region;  ///< ... a shape
  std::string follow_name;              ///< "": none
  int follow = -1;                      ///< its index among the bodies
  double margin = 0;                    ///< around it [m]
  std::string field;                    ///< name of a field of the points; "": none
  double above = 0;                     ///< its threshold
};

struct GridOptions {
  std::string where;
  double cell = 0;                                  ///< h [m]
  Triple min{}, max{};                              ///< domain [m]
  std::array<std::array<Boundary, 2>, 3> boundary;  ///< [axis][0 lower, 1 upper]
  std::vector<RefineOptions> refine;                ///< empty: one level
  bool merge = false;                               ///< points that came from finer cells
  int finest() const {
    int level = 0;
    for (const RefineOptions& rule : refine) level = level > rule.level ? level : rule.level;
    return level;
  }
};

struct TimeOptions {
  std::string where;
  double end = 0;  ///< [s]
  double cfl = 0.9;
  double max_step = 0;        ///< [s], 0: none
  double min_step = 0;        ///< [s], 0: 1e-6 of the first step
  double first_step = 0;      ///< [s], 0: automatic
  double energy_error = 0.1;  ///< a greater share that is not physical is a failure; 0: off
};

/// A law named in the scene with its parameters in declared order.
struct LawChoice {
  int law = -1;  ///< index in catalogue()
  std::string name, where;
  std::vector<double> values;
};

struct MaterialOptions {
  std::string name, where;
  double density = 0, shear_modulus = 0, initial_temperature = 293;
  std::optional<double> bulk_modulus;  ///< of the elastic constants, where they give it
  std::optional<LawChoice> eos, strength, damage, viscosity, heating;  ///< absent: no such stage
  std::optional<LawChoice> model;  ///< coupled law, in place of eos, strength and damage
  Rate rate = Rate::truesdell;
  Coupling coupling = Coupling::effective;                      ///< of damage
  DegradePressure degrade_pressure = DegradePressure::tension;  ///< by damage
  FailureAction failure = FailureAction::strength_loss;
  std::optional<double> spall_strength;  ///< tension [Pa]; absent: no limit
  std::string spall_where, rate_where;   ///< empty: not asked for
  SpallAction spall_action = SpallAction::fail;
  bool bare = false;                   ///< no law: enough for rigid bodies
  std::string card;                    ///< file of its card, "": none
  std::vector<std::string> unused;     ///< keys of its card that the scene does not ask for
  std::vector<std::string> unsourced;  ///< values of its card that came from no source read
};

/// A vector field given by expressions in x y z r t (and X Y Z R: position at the start), or
/// constants.
class FieldFunction {
 public:
  virtual ~FieldFunction() = default;
  virtual bool depends_on_time() const = 0;
  /// x: current, X: initial position along grid axes; result along grid axes.
  virtual Triple operator()(const Triple& x, const Triple& X, double t) const = 0;
};

/// How a body is divided into points.
struct PointOptions {
  std::array<int, 3> per_direction{2, 2, 2};  ///< per grid axis
  bool fit_to_body = false;
  double jitter = 0;  ///< fraction of the point spacing
  unsigned seed = 1;
  std::vector<RefinedZone> zones;
};

enum class Motion { deformable, prescribed, free };  ///< prescribed, free: of a rigid body

struct BodyOptions {
  std::string name, where;
  int material = -1;                   ///< index in Scene::materials
  std::shared_ptr<const Solid> solid;  ///< without what other bodies win of it
  std::vector<int> wins_over;          ///< bodies that give way where they overlap this one
  bool thin_allowed = false;           ///< may be one cell thick or less
  double point_estimate = 0;           ///< number of its points, by its volume in the domain
  PointOptions points;
  std::shared_ptr<const FieldFunction> velocity;  ///< at the start, prescribed: at all times;
                                                  ///< null: at rest
  std::optional<MeshOptions> mesh;                ///< of elements
  std::optional<SphOptions> sph;                  ///< of particles; neither: of material points
  Motion motion = Motion::deformable;
  bool material_points() const { return !mesh && !sph; }
  /// Its elements may: they have the columns of points too.
  bool becomes_points() const { return mesh && mesh->converts; }
  bool rigid() const { return motion != Motion::deformable; }
};

struct OutputOptions {
  double frames = 0;   ///< [s] between frames, 0: first and last only
  double history = 0;  ///< [s] between history rows, 0: every step
  double checkpoint_wall =
      600;  ///< [s] of wall clock between checkpoints, 0: only at the end or on a signal
  std::vector<std::string> fields;  ///< extra fields asked for: names of points/fields.hpp
  std::string where;                ///< of `fields`
};

struct Scene {
  std::string file, title, resolved;  ///< resolved: YAML text with all defaults, for resolved.yaml
  Frame frame = Frame::cartesian_3d;
  GridOptions grid;
  TimeOptions time;
  MethodOptions method;
  ContactOptions contact;
  std::vector<MaterialOptions> materials;
  std::vector<BodyOptions> bodies;
  std::shared_ptr<const FieldFunction> body_force;  ///< acceleration [m/s^2]; null: none
  LoadOptions loads;
  std::vector<Detonator> detonators;
  std::vector<MeasureOptions> measures;
  std::vector<OutcomeOptions> outcomes;
  std::vector<GaugeOptions> gauges;
  StopOptions stop;
  OutputOptions output;
  std::vector<std::string> notes;  ///< remarks for the user (r_min: axis ignored in 3d, ...)
};

/// Read and check a scene. `overrides`: "path=value" strings of --set. Throws InputError
/// (`FILE:LINE: path: ...`).
Scene read_scene(const std::string& file, const std::vector<std::string>& overrides = {});

/// A material card by itself, and the cards that a scene in the current folder may name.
struct CardSummary {
  std::string file, yaml;              ///< yaml: its values as written
  std::vector<std::string> unsourced;  ///< as of MaterialOptions
};

namespace scene {
CardSummary read_card(const std::string& name);  ///< throws InputError
std::vector<std::string> known_cards();
/// What stands in a scene for a card that is generated, one example a model.
std::vector<std::string> generated_cards();
}  // namespace scene

}  // namespace krater
