// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/readers/readers.hpp
/// The readers of a scene's blocks. Each fills its part of the Scene, reports what is wrong and
/// returns the block with all defaults for resolved.yaml. Order matters: the frame first, then the
/// grid, materials, bodies, measures.
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "krater/scene/scene.hpp"
#include "scene/declarations/declarations.hpp"
#include "scene/yaml/block.hpp"
#include "scene/yaml/problems.hpp"
#include "scene/yaml/tree.hpp"

namespace krater::scene {

/// What every reader needs: the scene being filled, the problems found, the root of the document.
struct Reading {
  Scene& scene;
  Problems& problems;
  const Node& root;
};

Node read_grid(const Node* node, Reading& reading);
/// `refine:` of the grid, a list of rules.
void read_refine(Block& grid, Reading& reading);
/// Points that finer cells add to a body at the start, about.
double points_of_levels(const BodyOptions& body, const Scene& scene, double per_cell);
/// What levels of cells do not go with; after all blocks.
void check_refine(Reading& reading);
Node read_time(const Node* node, Reading& reading);
Node read_method(const Node* node, Reading& reading);
Node read_output(const Node* node, Reading& reading);
Node read_materials(const Node* node, Reading& reading);
Node read_bodies(const Node* node, Reading& reading);
/// `rigid:` of a body: `free`, or `{velocity: [..]}` at all times. Returns the resolved key.
Node read_rigid(const Node& node, BodyOptions& body, Reading& reading);
/// Materials without laws, and rigid bodies without contact; after all blocks.
void check_rigid(Reading& reading);
/// `kinematics:` of a body. Returns the resolved key.
Node read_kinematics(const Node& node, BodyOptions& body, Reading& reading);
/// `reference: current | initial | adaptive | {adaptive: {strain: 0.3}}` of elements and particles:
/// 0, 1, 2.
int read_reference(Block& parent, double& strain, Reading& reading);
/// `sph:` in it, null: all defaults. Returns the resolved block.
Node read_sph(const Node* node, const Node& place, BodyOptions& body, Reading& reading);
/// Particles along a cell: a whole number, or the scene is refused.
int particles_per_cell(const BodyOptions& body, const Scene& scene);
/// What no kinematics but mpm knows yet: loads, detonators, sides that drive.
void refuse_idle(const std::string& kinematics, const Node& place, Reading& reading);
/// What bodies of particles do not go with; after all blocks.
void check_particles(Reading& reading);
/// What bodies of elements do not go with; after all blocks. Counts their elements.
void check_meshes(Reading& reading);
Node read_contact(const Node& node, Reading& reading);  ///< after read_bodies
Node read_measures(const Node* node, Reading& reading);
/// `face: z_max`: axis and side (0 lower, 1 upper) of the outward normal; axis -1 after a problem.
std::pair<int, int> read_face_name(const Node& node, Reading& reading);
/// `{z_min: 8 mm, r_max: 3 mm}`: bounds by grid axis.
void read_bounds(Block& block, std::array<std::array<double, 2>, 3>& region, Reading& reading);

/// A value, an expression in t, or `{table: [[time, value], ...]}`.
struct ReadTime {
  TimeFunction value;
  Node resolved;
};
std::optional<ReadTime> read_time_function(const Node& node, const char* unit, Reading& reading);
/// `damping:` and `loads:`, after read_bodies; loads on sides of the box find their bodies.
void read_loads(Block& root, Reading& reading);
void read_detonators(Block& root, Reading& reading);
/// `outcomes:` and `time.stop_when`, which may add one; after read_bodies.
Node read_outcomes(const Node* node, Reading& reading);
void read_stop(const Node& node, Reading& reading);
Node read_gauges(const Node* node, Reading& reading);
Node read_references(const Node* node, Reading& reading);  ///< after read_measures

/// A model that makes its shear modulus of its own constants gives that of the material, and says
/// what it implies.
void take_shear_modulus(MaterialOptions& material, Block& block, Reading& reading);
/// Largest width over which the softening of a material may localise [m]; nothing where no energy
/// rules it.
std::optional<double> softening_length(const MaterialOptions& material);
/// A point, or the cells of bodies of material points, that are wider; after all blocks.
void check_softening(const MaterialOptions& material, double length, Block& point);
void check_softening(Reading& reading);

/// Index of the body that a node names; -1 after a problem.
int read_body_name(const Node& node, Reading& reading);

/// A solid and its resolved block; a null solid after a problem.
struct ReadSolid {
  std::shared_ptr<const Solid> solid;
  Node resolved;
};
ReadSolid read_solid(const Node& shape, Reading& reading);

/// A vector along the grid axes. Two components are (radial or x, axial z); in 3d the first of two
/// must be zero, for it could mean x as well as r. Three components are (x, y, z); in 2D frames
/// what the section lacks must be zero.
std::optional<Triple> read_vector(const Node& node, const char* unit, Reading& reading);

/// A position in 3D space from two (x or r, z) or three components.
std::optional<Triple> read_position(const Node& node, Reading& reading);
/// The same along the grid axes.
std::optional<Triple> read_place(const Node& node, Reading& reading);
/// `min` and `max` of a box along the grid axes. Corners with two components are (r or x, z); in 3d
/// the box is then as wide across y as across x.
std::optional<Box> read_corners(Block& block, Reading& reading);

/// A vector field along the grid axes: numbers with units or expressions. `field` is null where it
/// is zero everywhere.
struct ReadField {
  std::shared_ptr<const FieldFunction> field;
  Node resolved;
  bool expression = false;  ///< not all components are numbers
};
std::optional<ReadField> read_field(const Node& node, const char* unit, Reading& reading);

/// `[0, -1]` or `-z`: a unit vector along the grid axes.
std::optional<Triple> read_direction(const Node& node, Reading& reading);
/// `{speed: 830 m/s, towards: [0, -1]}` or `{speed: 830 m/s, angle: 30 degree}`.
std::optional<Triple> read_speed(const Node& node, Reading& reading);
/// A velocity by components, numbers or expressions, or by its speed and direction.
std::optional<ReadField> read_velocity(const Node& node, Reading& reading);
/// `velocity` and `turn` of a body or of a rigid body's motion; null: at rest. `solid` gives the
/// centre of a turn that names none.
std::shared_ptr<const FieldFunction> read_motion(Block& block, const Solid* solid,
                                                 Reading& reading);

/// A vector as resolved.yaml shows it: one component per grid axis.
Node vector_node(Frame frame, const Triple& value);

/// What may be measured or written: name and unit of every field of the points.
struct FieldName {
  const char* name;
  const char* unit;
};
const std::vector<FieldName>& known_fields();

/// Checks that need the whole scene (combinations, bodies in the domain); reports and adds notes.
void check_scene(Reading& reading);

}  // namespace krater::scene
