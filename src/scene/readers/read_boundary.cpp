// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/readers/read_boundary.hpp"

#include <array>
#include <limits>

#include "krater/scene/yaml/units.hpp"

namespace krater::scene {

namespace {

constexpr const char* kFriction = "friction";

struct GivenBoundary {
  Boundary boundary;
  bool is_axis = false;
  const Node* node = nullptr;
  std::optional<ReadTime> pressure;  ///< on the bodies that reach the side, which is open
};

struct Kind {
  const char* name;
  BoundaryKind kind;
  bool is_axis;
};

constexpr std::array kKinds{
    Kind{"axis", BoundaryKind::symmetry, true}, Kind{"symmetry", BoundaryKind::symmetry, false},
    Kind{"open", BoundaryKind::open, false},    Kind{"sticky", BoundaryKind::sticky, false},
    Kind{"wall", BoundaryKind::wall, false},    Kind{"velocity", BoundaryKind::velocity, false},
    Kind{"pressure", BoundaryKind::open, false}};

constexpr double kSticks = std::numeric_limits<double>::infinity();

/// `[0, -10 m/s]` or `{speed: 10 m/s, towards: -z}`, which stick, or `{of: [0, -10 m/s], friction:
/// 0.1}`.
void read_driven(const Node& node, const Choice& choice, Reading& reading, Boundary& boundary) {
  boundary.friction = kSticks;
  const Node* velocity = choice.value;
  if (velocity && velocity->kind == Node::Kind::map && !velocity->find("speed")) {
    Block block{driven_side_block(), choice.value, node.path + "." + choice.name, node,
                reading.problems};
    velocity = block.find("of");
    if (block.find(kFriction)) boundary.friction = block.number(kFriction);
    block.finish();
  }
  if (!velocity)
    reading.problems.add(node.file, node.line, node.path,
                         "expected {velocity: [radial or x, axial z]} or {velocity: {of: [radial "
                         "or x, axial z], friction: 0}}");
  else if (const auto read = velocity->kind == Node::Kind::map
                                 ? read_speed(*velocity, reading)
                                 : read_vector(*velocity, "m/s", reading))
    boundary.velocity = *read;
}

/// `contact: {walls: 0.1}`: of walls that name no friction. What is wrong with it the contact
/// block's reader says.
double friction_of_walls(const Reading& reading) {
  const Node* contact = reading.root.find("contact");
  const Node* walls = contact ? contact->find("walls") : nullptr;
  if (!walls) return 0;
  const QuantityText read = parse_quantity(walls->text, "1");
  return read.problem.empty() && read.value > 0 ? read.value : 0;
}

/// `open`, `{wall: {friction: 0.1}}` or `{velocity: [0, 10 m/s]}`.
GivenBoundary read_side(const Node& node, Reading& reading) {
  GivenBoundary side;
  side.node = &node;
  side.boundary.where = node.where();
  const std::optional<Choice> choice = read_choice(node, "condition", reading.problems);
  if (!choice) return side;
  const Kind* kind = nullptr;
  std::vector<std::string> known;
  for (const Kind& candidate : kKinds) {
    known.emplace_back(candidate.name);
    if (choice->name == candidate.name) kind = &candidate;
  }
  if (!kind) {
    report_unknown(*choice->place, "condition", choice->name, known, reading.problems);
    return side;
  }
  side.boundary.kind = kind->kind;
  side.is_axis = kind->is_axis;
  if (choice->name == "pressure") {
    if (choice->value)
      side.pressure = read_time_function(*choice->value, "Pa", reading);
    else
      reading.problems.add(node.file, node.line, node.path, "expected {pressure: 1 GPa}");
  } else if (kind->kind == BoundaryKind::velocity) {
    read_driven(node, *choice, reading, side.boundary);
  } else if (choice->value) {
    Block block{member(side_block(), choice->name), choice->value, node.path + "." + choice->name,
                node, reading.problems};
    if (kind->kind == BoundaryKind::wall)
      side.boundary.friction = block.number(kFriction, friction_of_walls(reading));
    block.finish();
  } else if (kind->kind == BoundaryKind::wall) {
    side.boundary.friction = friction_of_walls(reading);
  }
  return side;
}

class Sides {
 public:
  Sides(const BoxInfo& box, Block& block, Reading& reading)
      : box_{box}, block_{block}, reading_{reading}, frame_{reading.scene.frame} {}

  /// In the 2D frames x and r are one side.
  void read_2d() {
    for (int side = 0; side < 2; ++side) {
      const Node* x = block_.find(key("x", side));
      const Node* r = block_.find(key("r", side));
      if (x && r)
        fail(*r, "is the same side as " + std::string{key("x", side)} + ", which is also given");
      if (const Node* node = r ? r : x) set(0, side, read_side(*node, reading_));
      if (const Node* node = block_.find(key("z", side))) set(1, side, read_side(*node, reading_));
      if (const Node* node = block_.find(key("y", side))) {
        fail(*node, "there is no y where the frame is " + std::string{name(frame_)});
      }
    }
    check_axis_2d();
  }

  void read_3d() {
    for (int side = 0; side < 2; ++side) {
      if (const Node* node = block_.find(key("z", side))) set(2, side, read_side(*node, reading_));
    }
    if (const Node* node = block_.find(key("r", 0))) read_inner(*node);
    if (const Node* node = block_.find(key("r", 1))) set_around(*node);
    for (int side = 0; side < 2; ++side) {
      for (int axis = 0; axis < 2; ++axis) {
        const Node* node = block_.find(key(axis == 0 ? "x" : "y", side));
        if (!node) continue;
        if (box_.revolve && axis == 1) {
          fail(*node, "a box of two components has no y sides; give three components");
        } else if (box_.revolve) {
          side == 0 ? read_inner(*node) : set_around(*node);
        } else {
          set(axis, side, read_side(*node, reading_));
        }
      }
    }
    check_no_axis_3d();
  }

  /// The resolved pressure of a side; null: none.
  const Node* pressure(int axis, int side) const {
    const auto& given = given_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)];
    return given.pressure ? &given.pressure->resolved : nullptr;
  }

 private:
  static const char* key(const char* axis, int side) {
    static constexpr std::array<std::array<const char*, 2>, 4> keys{
        {{"x_min", "x_max"}, {"y_min", "y_max"}, {"z_min", "z_max"}, {"r_min", "r_max"}}};
    for (const auto& pair : keys) {
      if (pair[0][0] == axis[0]) return pair[static_cast<std::size_t>(side)];
    }
    return "";
  }

  void fail(const Node& at, const std::string& message) { block_.fail(at, message); }

  void set(int axis, int side, const GivenBoundary& given) {
    const auto a = static_cast<std::size_t>(axis);
    const auto s = static_cast<std::size_t>(side);
    if (given_[a][s].node) fail(*given.node, "this side already has a condition");
    given_[a][s] = given;
    reading_.scene.grid.boundary[a][s] = given.boundary;
    if (!given.pressure) return;
    FaceLoad load;
    load.name = std::string{axis_name(frame_, axis)} + (side == 0 ? "_min" : "_max");
    load.where = given.boundary.where;
    load.axis = axis;
    load.side = side;
    load.value[0] = given.pressure->value;
    reading_.scene.loads.faces.push_back(std::move(load));
  }

  /// r_min in 3d: the axis is no side there.
  void read_inner(const Node& node) {
    const GivenBoundary given = read_side(node, reading_);
    const BoundaryKind kind = given.boundary.kind;
    if (kind == BoundaryKind::symmetry) {
      reading_.scene.notes.push_back(
          node.where() + ": passed over in 3d, where the axis is no side of the domain");
    } else if (kind != BoundaryKind::open) {
      fail(node, "in 3d the axis is no side of the domain and carries no condition");
    }
  }

  void set_around(const Node& node) {
    const GivenBoundary given = read_side(node, reading_);
    for (int axis = 0; axis < 2; ++axis) {
      for (int side = 0; side < 2; ++side) set(axis, side, given);
    }
  }

  void check_axis_2d() {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (std::size_t side = 0; side < 2; ++side) {
        const GivenBoundary& given = given_[axis][side];
        if (!given.is_axis || !box_.known) continue;
        if (axis != 0 || side != 0)
          fail(*given.node, "the axis can only be the lower r side; did you mean symmetry?");
        else if (box_.lower_r != 0)
          fail(*given.node, "the axis needs a box that begins at 0");
      }
    }
    if (frame_ != Frame::axisymmetric || !box_.known || box_.lower_r != 0) return;
    Boundary& inner = reading_.scene.grid.boundary[0][0];
    const GivenBoundary& given = given_[0][0];
    if (given.node && given.boundary.kind != BoundaryKind::symmetry) {
      fail(*given.node,
           "the box begins at r = 0: this side is the axis (write axis or leave it out)");
    }
    if (!given.node) inner = {BoundaryKind::symmetry, 0, {}, block_.place().where()};
  }

  void check_no_axis_3d() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t side = 0; side < 2; ++side) {
        const GivenBoundary& given = given_[axis][side];
        if (given.is_axis) fail(*given.node, "the axis is no side in 3d; did you mean symmetry?");
      }
    }
  }

  const BoxInfo& box_;
  Block& block_;
  Reading& reading_;
  Frame frame_;
  std::array<std::array<GivenBoundary, 2>, 3> given_;
};

Node side_node(const Boundary& boundary, bool is_axis, Frame frame) {
  Node node;
  switch (boundary.kind) {
    case BoundaryKind::open:
      return string_node("open");
    case BoundaryKind::symmetry:
      return string_node(is_axis ? "axis" : "symmetry");
    case BoundaryKind::sticky:
      return string_node("sticky");
    case BoundaryKind::wall: {
      Node options;
      add_member(options, kFriction, number_node(boundary.friction));
      add_member(node, "wall", options);
      return node;
    }
    case BoundaryKind::velocity: {
      Node velocity = vector_node(frame, boundary.velocity);
      if (boundary.friction < kSticks) {
        Node options;
        add_member(options, "of", velocity);
        add_member(options, kFriction, number_node(boundary.friction));
        velocity = options;
      }
      add_member(node, "velocity", velocity);
      return node;
    }
  }
  return node;
}

}  // namespace

Node read_boundary(const Node* node, const BoxInfo& box, Block& grid, Reading& reading) {
  const Frame frame = reading.scene.frame;
  Block block{boundary_block(), node, "grid.boundary", grid.place(), reading.problems};
  Sides sides{box, block, reading};
  dimension(frame) == 2 ? sides.read_2d() : sides.read_3d();
  block.finish();
  Node resolved;
  resolved.kind = Node::Kind::map;
  for (int axis = 0; axis < dimension(frame); ++axis) {
    for (int side = 0; side < 2; ++side) {
      const Boundary& boundary =
          reading.scene.grid
              .boundary[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)];
      const bool is_axis =
          frame == Frame::axisymmetric && axis == 0 && side == 0 && box.lower_r == 0;
      const std::string key = std::string{axis_name(frame, axis)} + (side == 0 ? "_min" : "_max");
      if (const Node* pressure = sides.pressure(axis, side)) {
        Node pressed;
        add_member(pressed, "pressure", *pressure);
        add_member(resolved, key, pressed);
      } else {
        add_member(resolved, key, side_node(boundary, is_axis, frame));
      }
    }
  }
  return resolved;
}

}  // namespace krater::scene
