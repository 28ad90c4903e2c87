// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <sstream>

#include "krater/geometry/solids/csg.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

namespace {

/// Of what a body may lose at the sides of the domain before it is said, and what round-off may
/// claim.
constexpr double kLostFraction = 1e-9;
/// Bodies that touch overlap by round-off: in cells, and parts of a cell's content.
constexpr double kTouching = 1e-6;

void fail(const std::string& path, const std::string& message, Reading& reading) {
  const Node* node = &reading.root;
  for (std::size_t start = 0; start <= path.size();) {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    const Node* next = node->find(path.substr(start, dot - start));
    if (!next) break;
    node = next;
    start = dot + 1;
  }
  reading.problems.add(node->file, node->line, path, message);
}

std::string short_text(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

/// Combinations of shape, update and transfer that fail, and what those cost that only lose. Near
/// the edge of a hat the nodal acceleration grows like 1/distance, and so does the velocity
/// gradient with update usl (src/THEORY.md 17); a gradient of linear functions that the points
/// carry (tflip, apic) grows by itself. The figures are those of an elastic disc after three turns
/// (src/README.md).
void check_method(Reading& reading) {
  const MethodOptions& method = reading.scene.method;
  const bool linear = method.shape == Shape::linear, usl = method.update == Update::usl;
  const bool affine = method.transfer == Transfer::tflip || method.transfer == Transfer::apic;
  std::vector<std::string>& notes = reading.scene.notes;
  const bool current = method.reference == Reference::current;  // else no point crosses a cell
  if (linear && current && (usl || affine)) {
    fail("method.shape",
         std::string{"shape linear is unstable with "} +
             (usl ? "update usl" : "transfers that carry a velocity gradient (tflip, apic)") +
             "; use shape: quadratic_bspline",
         reading);
  }
  if (method.shape == Shape::gimp && usl && method.transfer == Transfer::flip) {
    fail("method",
         "shape gimp is unstable with update usl and transfer flip (src/THEORY.md 17); use "
         "transfer: "
         "tflip or shape: quadratic_bspline",
         reading);
  }
  if (method.transfer == Transfer::xpic && !usl) {
    fail("method.transfer",
         "the filter of xpic belongs to update usl; with musl or usf nothing would be left of it "
         "but its loss; use update: usl, or transfer: tflip",
         reading);
  }
  for (const auto& sides : reading.scene.grid.boundary)
    for (const Boundary& side : sides)
      if (method.transfer == Transfer::xpic && side.drives())
        fail(
            "method.transfer",
            "a side with a velocity does not go with transfer xpic: its filter would undo what the "
            "side drives; use tflip, flip or apic",
            reading);
  if (method.transfer == Transfer::xpic && usl) {
    notes.push_back(
        "method: xpic takes rotation away: a spinning disc keeps a tenth of its angular momentum "
        "for three turns (order 2); tflip and apic keep it");
    if (method.xpic_order > 2 && reading.scene.time.cfl >= 0.5)
      notes.push_back("method: xpic of order " + std::to_string(method.xpic_order) +
                      " with update usl was unstable from cfl 0.5 on in tests (src/THEORY.md 17)");
  }
}

/// A fixed reference has one sweep; bodies share no grid but that of contact.
void check_reference(Reading& reading) {
  const MethodOptions& method = reading.scene.method;
  if (method.reference == Reference::current) return;
  if (method.update != Update::usl || method.transfer == Transfer::xpic)
    fail("method.reference",
         "only reference: current works with update musl or usf or with transfer xpic; use update: "
         "usl and transfer tflip, flip or apic",
         reading);
  for (const BodyOptions& body : reading.scene.bodies)
    if (body.rigid())
      fail("bodies." + body.name + ".rigid",
           "rigid bodies meet others on method.reference: current only", reading);
  if (reading.scene.bodies.size() > 1 && !reading.scene.contact.active)
    reading.scene.notes.push_back(
        "method.reference: every body has a reference grid of its own: without a contact block "
        "bodies pass through each other; contact: {friction: 0} lets them meet");
}

void check_contact(Reading& reading) {
  Scene& scene = reading.scene;
  if (!scene.contact.active) {
    if (scene.bodies.size() > 1 && scene.method.reference == Reference::current)
      scene.notes.push_back(
          "no contact block: the bodies share one velocity field and stick where they meet; "
          "contact: {friction: 0} lets them push, slide and part");
    return;
  }
  const bool becomes_points = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                          [](const BodyOptions& b) { return b.becomes_points(); });
  if (scene.bodies.size() < 2 && !becomes_points)
    scene.notes.push_back("contact: there is one body; a body has no contact with itself");
  if (scene.method.transfer == Transfer::xpic)
    fail("contact",
         "contact does not go with transfer xpic: its filter would undo the impulses; "
         "use tflip, flip or apic",
         reading);
}

/// A body that sticks out of the domain loses what is outside: meant at a plane of symmetry, else
/// worth saying.
void check_sides(const BodyOptions& body, Reading& reading) {
  const Scene& scene = reading.scene;
  const GridOptions& grid = scene.grid;
  const Box extent = body.solid->extent(scene.frame);
  for (int axis = 0; axis < dimension(scene.frame); ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!std::isfinite(extent.length(axis))) continue;  // meant to end at the domain
    const std::array<double, 2> outside{grid.min[a] - extent.min[a], extent.max[a] - grid.max[a]};
    for (std::size_t side = 0; side < 2; ++side) {
      if (outside[side] <= 1e-6 * grid.cell) continue;
      const BoundaryKind kind = grid.boundary[a][side].kind;
      if (kind == BoundaryKind::symmetry) continue;
      const std::string which =
          std::string{axis_name(scene.frame, axis)} + (side == 0 ? "_min" : "_max");
      const std::string message =
          "sticks out of the domain at " + which + " by " + short_text(outside[side]) + " m";
      if (kind == BoundaryKind::open) {
        reading.scene.notes.push_back(body.where + ": " + message +
                                      "; what is outside is left out");
      } else {
        fail("bodies." + body.name, message + ", through a side that carries a condition", reading);
      }
    }
  }
}

/// The shape of a body as the user wrote it, without the maps around it.
const Node& drawn_shape(const BodyOptions& body, const Reading& reading) {
  const Node* node = reading.root.find("bodies")->find(body.name)->find("shape");
  const auto is_map = [](const Node& n) {
    return n.items.size() == 1 &&
           (n.items[0].key == "move" || n.items[0].key == "rotate" || n.items[0].key == "scale") &&
           n.items[0].find("shape");
  };
  while (is_map(*node)) node = node->items[0].find("shape");
  return *node;
}

/// Why a body holds nothing at all, wherever the domain lies.
std::string why_empty(const BodyOptions& body, const Reading& reading) {
  const Frame frame = reading.scene.frame;
  for (const BodyOptions& other : reading.scene.bodies)
    for (const int loser : other.wins_over)
      if (&reading.scene.bodies[static_cast<std::size_t>(loser)] == &body)
        return "nothing is left of it: " + quote(other.name) + " and others win over all of it";
  const Node& shape = drawn_shape(body, reading);
  const std::string kind = shape.items.empty() ? shape.text : shape.items[0].key;
  const Box box = body.solid->bounding_box();
  const std::string section =
      frame == Frame::cartesian_3d ? "" : " in the section y = 0 that this frame computes";
  if (!section.empty() && !is_empty(box, 3) && (box.min[1] > 0 || box.max[1] < 0))
    return "is empty" + section + ": the shape spans y = " + short_text(box.min[1]) + " to " +
           short_text(box.max[1]) + " m";
  if (frame == Frame::axisymmetric && !is_empty(box, 3) && box.max[0] <= 0)
    return "is empty: the shape lies at r < 0";
  if (kind == "intersection")
    return "is empty: the shapes of its intersection do not overlap" + section;
  if (kind == "difference")
    return "is empty: the shapes taken away leave nothing of the first" + section;
  return "is empty: its shape holds no material" + section;
}

/// "r = 0 to 0.01, z = 0 to 0.02 m"
std::string span_text(const Box& box, Frame frame) {
  std::string text;
  for (int axis = 0; axis < dimension(frame); ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    text += (axis == 0 ? "" : ", ") + std::string{axis_name(frame, axis)} + " = " +
            short_text(box.min[a]) + " to " + short_text(box.max[a]);
  }
  return text + " m";
}

/// Points that zones add, without their belts.
double points_of_zones(const BodyOptions& body, const Scene& scene, double per_cell) {
  const int dim = dimension(scene.frame);
  double points = 0;
  for (const RefinedZone& zone : body.points.zones) {
    const Box box = intersection(zone.box, {scene.grid.min, scene.grid.max}, dim);
    if (is_empty(box, dim)) continue;
    double more = 1;
    for (int a = 0; a < dim; ++a) more *= zone.points_per_direction[static_cast<std::size_t>(a)];
    points += std::max(0.0, more - per_cell) * body.solid->part(scene.frame, box).section /
              std::pow(scene.grid.cell, dim);
  }
  return points;
}

/// Sides that move: inwards, and not as far as the other side.
void check_driven_sides(Reading& reading) {
  const Scene& scene = reading.scene;
  const GridOptions& grid = scene.grid;
  for (int axis = 0; axis < dimension(scene.frame); ++axis)
    for (std::size_t side = 0; side < 2; ++side) {
      const auto a = static_cast<std::size_t>(axis);
      const Boundary& plane = grid.boundary[a][side];
      if (!plane.drives()) continue;
      const std::string path = "grid.boundary." + std::string{axis_name(scene.frame, axis)} +
                               (side == 0 ? "_min" : "_max");
      if (scene.method.reference != Reference::current)
        fail(path, "a side with a velocity needs method.reference: current", reading);
      const double inwards = (side == 0 ? 1 : -1) * plane.velocity[a];
      if (inwards < 0)
        fail(path,
             "a side can only move into the domain, as a piston does; to pull, or to draw a piston "
             "back, use a rigid body (bodies.NAME.rigid) inside an open side",
             reading);
      const double room = grid.max[a] - grid.min[a] - 3 * grid.cell;
      if (inwards * scene.time.end > room)
        fail(path,
             "the side would reach the other one at " +
                 short_text((grid.max[a] - grid.min[a]) / inwards) +
                 " s; use an earlier time.end (less than " + short_text(room / inwards) +
                 " s) or a larger grid.box",
             reading);
    }
}

void check_body(BodyOptions& body, Reading& reading) {
  const Scene& scene = reading.scene;
  const GridOptions& grid = scene.grid;
  const Box domain{grid.min, grid.max};
  const CellPart part = body.solid->part(scene.frame, domain);
  const CellPart whole = body.solid->part(scene.frame, body.solid->extent(scene.frame));
  if (!(whole.measure > 0)) {
    fail("bodies." + body.name, why_empty(body, reading), reading);
    return;
  }
  const double least = std::isfinite(whole.measure) ? kLostFraction * whole.measure : 0;
  if (!(part.measure > least)) {
    fail("bodies." + body.name,
         "lies outside the domain: it spans " +
             span_text(body.solid->extent(scene.frame), scene.frame) + ", grid.box " +
             span_text(domain, scene.frame),
         reading);
    return;
  }
  check_sides(body, reading);
  const double cells = part.section / std::pow(grid.cell, dimension(scene.frame));
  if (cells < 1) {
    reading.scene.notes.push_back(body.where + ": is smaller than one cell (" +
                                  short_text(100 * cells) + " % of it)");
  }
  double per_cell = 1;
  for (int a = 0; a < dimension(scene.frame); ++a)
    per_cell *= body.points.per_direction[static_cast<std::size_t>(a)];
  body.point_estimate = cells * per_cell + points_of_zones(body, scene, per_cell) +
                        points_of_levels(body, scene, per_cell);
}

/// Bodies that share material have that mass twice, and push each other apart from the start.
void check_overlap(const BodyOptions& a, const BodyOptions& b, Reading& reading) {
  const Frame frame = reading.scene.frame;
  const int dim = dimension(frame);
  const Box domain{reading.scene.grid.min, reading.scene.grid.max};
  const Box common =
      intersection(intersection(a.solid->extent(frame), b.solid->extent(frame), dim), domain, dim);
  for (int axis = 0; axis < dim; ++axis) {
    if (!(common.length(axis) > kTouching * reading.scene.grid.cell)) return;
  }
  const auto both = make_boolean(Boolean::intersect, {a.solid, b.solid});
  const CellPart part = both->part(frame, common);
  if (!(part.section > kTouching * std::pow(reading.scene.grid.cell, dim))) return;
  std::string place;
  for (int axis = 0; axis < dim; ++axis)
    place += (axis == 0 ? "" : ", ") + short_text(part.centroid[static_cast<std::size_t>(axis)]);
  fail("bodies." + b.name,
       "overlaps body " + quote(a.name) + " by " + short_text(part.measure) + " m^3 about (" +
           place + ") m; move one of them, or say who wins: bodies." + a.name + ".wins_over: [" +
           b.name + "] or the other way round",
       reading);
}

}  // namespace

void check_scene(Reading& reading) {
  Scene& scene = reading.scene;
  check_method(reading);
  check_reference(reading);
  check_contact(reading);
  check_driven_sides(reading);
  check_rigid(reading);
  std::vector<bool> used(scene.materials.size(), false);
  for (BodyOptions& body : scene.bodies) {
    check_body(body, reading);
    used[static_cast<std::size_t>(body.material)] = true;
  }
  check_meshes(reading);
  check_particles(reading);
  check_softening(reading);
  check_refine(reading);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < scene.bodies.size(); ++j)
      check_overlap(scene.bodies[i], scene.bodies[j], reading);
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) scene.notes.push_back(scene.materials[i].where + ": no body is made of it");
  }
}

}  // namespace krater::scene
