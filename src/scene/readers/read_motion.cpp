// SPDX-License-Identifier: GPL-3.0-or-later
// How a body moves at the start, or a rigid one for ever: v = v_0 + omega x (x - c - t v_0).
#include <cmath>
#include <string_view>

#include "krater/scene/yaml/expression.hpp"
#include "krater/scene/yaml/units.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

/// A translation that carries its centre of rotation along.
class TurningField final : public FieldFunction {
 public:
  TurningField(Frame frame, const Triple& velocity, const Triple& spin, const Triple& centre)
      : frame_{frame}, velocity_{velocity}, spin_{spin}, centre_{centre} {}
  bool depends_on_time() const override { return velocity_ != Triple{}; }
  Triple operator()(const Triple& x, const Triple&, double t) const override {
    const Triple v = to_space(frame_, velocity_);
    Triple d = to_space(frame_, x);
    for (std::size_t k = 0; k < 3; ++k) d[k] -= centre_[k] + t * v[k];
    Triple out = velocity_;
    for (int a = 0; a < dimension(frame_); ++a) {
      const auto i = static_cast<std::size_t>(tensor_axis(frame_, a)), j = (i + 1) % 3,
                 k = (i + 2) % 3;
      out[static_cast<std::size_t>(a)] += spin_[j] * d[k] - spin_[k] * d[j];
    }
    return out;
  }

 private:
  Frame frame_;
  Triple velocity_, spin_, centre_;  ///< along the grid axes; in space
};

double length(const Triple& v) { return std::hypot(v[0], v[1], v[2]); }

/// `-z`, `x`: the unit vector in space.
std::optional<Triple> axis_of_word(std::string_view word) {
  const double sign = word.starts_with('-') ? -1 : 1;
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  constexpr std::string_view axes = "xyz";
  const std::size_t at = word.size() == 1 ? axes.find(word) : std::string_view::npos;
  if (at == std::string_view::npos) return std::nullopt;
  Triple out{};
  out[at] = sign;
  return out;
}

}  // namespace

std::optional<Triple> read_direction(const Node& node, Reading& reading) {
  std::optional<Triple> along;
  if (node.kind == Node::Kind::scalar) {
    const Frame frame = reading.scene.frame;
    if (const auto word = axis_of_word(node.text == "r" ? "x" : node.text)) {
      along = Triple{};
      double seen = 0;
      for (int a = 0; a < dimension(frame); ++a)
        seen += std::abs((*along)[static_cast<std::size_t>(a)] =
                             (*word)[static_cast<std::size_t>(tensor_axis(frame, a))]);
      if (seen == 0) along.reset();
    }
    if (!along) {
      reading.problems.add(node.file, node.line, node.path,
                           quote(node.text) + " is no direction of " + std::string{name(frame)} +
                               "; write a vector, or x, -x, z, -z" +
                               (dimension(frame) == 3 ? ", y, -y" : ""));
      return std::nullopt;
    }
  } else {
    along = read_vector(node, "1", reading);
  }
  if (!along) return std::nullopt;
  const double size = length(*along);
  if (!(size > 0)) {
    reading.problems.add(node.file, node.line, node.path, "is zero, which is no direction");
    return std::nullopt;
  }
  for (double& x : *along) x /= size;
  return along;
}

namespace {

/// `angle: 30 deg`, along the grid axes; an axis of revolution leaves only up and down.
std::optional<Triple> oblique(double angle, const Node& node, Reading& reading) {
  const Frame frame = reading.scene.frame;
  Triple along{};
  along[static_cast<std::size_t>(dimension(frame) - 1)] = -std::cos(angle);
  if (frame != Frame::axisymmetric) {
    along[0] = std::sin(angle);
  } else if (std::abs(std::sin(angle)) > 1e-12) {
    reading.problems.add(node.file, node.line, node.path,
                         "an axisymmetric body flies along its axis only: the angle is 0 (down) or "
                         "180 degree; use frame: 3d or plane_strain for an oblique impact");
    return std::nullopt;
  }
  return along;
}

/// About an axis of space: plane strain has y, the axisymmetric frame none.
std::optional<Triple> read_turning_axis(const Node* node, Block& block, Reading& reading) {
  const Frame frame = reading.scene.frame;
  if (frame == Frame::axisymmetric) {
    block.fail(
        "an axisymmetric body does not turn: the frame has no velocity about the axis; use "
        "frame: 3d");
    return std::nullopt;
  }
  Triple axis{0, 1, 0};
  if (node && node->kind == Node::Kind::list) {
    const auto given = read_position(*node, reading);
    if (!given) return std::nullopt;
    axis = *given;
  } else if (node) {
    const auto word = axis_of_word(node->text);
    if (!word) {
      block.fail(*node, "expected x, y, z, -x, -y, -z or a vector, found " + quote(node->text));
      return std::nullopt;
    }
    axis = *word;
  } else if (frame == Frame::cartesian_3d) {
    block.fail("missing key 'axis' (x, y, z, -x, -y, -z or a vector)");
    return std::nullopt;
  }
  const Node& place = node ? *node : block.place();
  if (!(length(axis) > 0)) {
    block.fail(place, "is zero, which is no axis");
    return std::nullopt;
  }
  if (frame == Frame::plane_strain && (axis[0] != 0 || axis[2] != 0)) {
    block.fail(place, "in plane_strain a body turns about y only");
    return std::nullopt;
  }
  return axis;
}

/// What a turn is through unless told otherwise: the body's centroid, in space.
std::optional<Triple> centroid(const Solid* solid, Frame frame) {
  if (!solid) return std::nullopt;
  const Box extent = solid->extent(frame);
  for (int a = 0; a < dimension(frame); ++a)
    if (!std::isfinite(extent.length(a))) return std::nullopt;
  return to_space(frame, solid->part(frame, extent).centroid);
}

Node space_node(const Triple& v) {
  return list_node({number_node(v[0]), number_node(v[1]), number_node(v[2])});
}

/// `turn: {axis: y, rate: 300 rpm, through: [0, 5 mm]}`; adds to `motion`.
Node read_turn(const Node& node, const Solid* solid, ReadField& motion, Reading& reading) {
  Block block{turn_block(), &node, node.path, node, reading.problems};
  const Node *axis_node = block.find("axis"), *rate_node = block.find("rate"),
             *through = block.find("through");
  const auto axis = read_turning_axis(axis_node, block, reading);
  if (rate_node && rate_node->text.find("Hz") != std::string::npos)
    block.fail(*rate_node, "of turns or of radians? write rpm or rad/s");
  const double rate = block.number("rate");
  std::optional<Triple> centre =
      through ? read_position(*through, reading) : centroid(solid, reading.scene.frame);
  if (!through && !centre && solid)
    block.fail(
        "missing key 'through', a point of the axis: the body has no centroid of its own, for "
        "it ends where the grid does");
  if (motion.field && motion.expression)
    block.fail(
        "a turn goes with a velocity of numbers, whose centre is known at all times; or write "
        "the turn into the expressions");
  if (reading.problems.any() || !axis || !centre) return block.finish();
  block.record("axis", space_node(*axis));
  block.record("through", space_node(*centre));
  Triple spin = *axis;
  for (double& w : spin) w *= rate / length(*axis);
  const Triple velocity = motion.field ? (*motion.field)({}, {}, 0) : Triple{};
  motion.field = std::make_shared<TurningField>(reading.scene.frame, velocity, spin, *centre);
  return block.finish();
}

}  // namespace

std::optional<Triple> read_speed(const Node& node, Reading& reading) {
  Block block{speed_block(), &node, node.path, node, reading.problems};
  const double speed = block.number("speed");
  const Node *towards = block.find("towards"), *angle = block.find("angle");
  std::optional<Triple> along;
  if (!towards == !angle) {
    block.fail(
        "a speed needs one direction: towards: [0, -1] (or -z, ...), or angle: 30 degree "
        "(obliquity: from -z towards +x)");
  } else if (towards) {
    along = read_direction(*towards, reading);
  } else if (const auto value = block.optional_number("angle")) {
    along = oblique(*value, *angle, reading);
  }
  block.finish();
  if (!along) return std::nullopt;
  for (double& v : *along) v *= speed;
  return along;
}

std::optional<ReadField> read_velocity(const Node& node, Reading& reading) {
  if (node.kind != Node::Kind::map) return read_field(node, "m/s", reading);
  const auto velocity = read_speed(node, reading);
  if (!velocity) return std::nullopt;
  ReadField out;
  if (length(*velocity) > 0) out.field = make_constant_field(*velocity);
  out.resolved = vector_node(reading.scene.frame, *velocity);
  return out;
}

std::shared_ptr<const FieldFunction> read_motion(Block& block, const Solid* solid,
                                                 Reading& reading) {
  ReadField motion;
  motion.resolved = vector_node(reading.scene.frame, Triple{});
  if (const Node* velocity = block.find("velocity"))
    if (std::optional<ReadField> read = read_velocity(*velocity, reading)) motion = *read;
  block.record("velocity", motion.resolved);
  if (const Node* turn = block.find("turn"))
    block.record("turn", read_turn(*turn, solid, motion, reading));
  return motion.field;
}

}  // namespace krater::scene
