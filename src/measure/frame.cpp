// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of all points, and meshes, as they are written.
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "krater/measure/measurements.hpp"
#include "krater/measure/snapshot.hpp"
#include "krater/points/place.hpp"

namespace krater {

namespace {

/// Points of a body in the order of their ids: all of them, or a slab.
struct DrawnPoints {
  std::size_t first = 0;
  BroughtPoints here;
};
using PointList = std::shared_ptr<const DrawnPoints>;

const std::vector<std::string>& tensor_names(Frame f) {
  static const std::vector<std::string> cartesian{"xx", "yy", "zz", "yz", "xz", "xy"};
  static const std::vector<std::string> cylindrical{"rr", "tt", "zz", "tz", "rz", "rt"};
  return f == Frame::axisymmetric ? cylindrical : cartesian;
}

const std::vector<std::string>& vector_names(Frame f) {
  static const std::vector<std::string> cartesian{"x", "y", "z"};
  static const std::vector<std::string> cylindrical{"r", "t", "z"};
  return f == Frame::axisymmetric ? cylindrical : cartesian;
}

/// Columns that serve the method, not the user.
bool is_internal(const char* name) {
  static const std::set<std::string> names{
      "id",       "position",      "affine_velocity",   "shock_indicator",   "half_width",
      "domain",   "grid_velocity", "body_acceleration", "deviatoric_stress", "load_share",
      "load_unit"};
  return names.contains(name);
}

bool asked_for(const Scene& scene, const char* name) {
  for (const std::string& f : scene.output.fields)
    if (f == name) return true;
  return false;
}

/// Rows of `width` numbers, each made by `put(number, row)`.
template <class T, class Put>
Rows<T> numbered_rows(int width, Put put) {
  return [width, put](std::size_t first, std::size_t count, T* out) {
    for (std::size_t i = first; i < first + count; ++i, out += width) put(i, out);
  };
}

/// Rows of `width` numbers, each made by `put(point, row)`.
template <class T, class Put>
Rows<T> rows_of(const PointList& points, int width, Put put) {
  return numbered_rows<T>(width, [points, put](std::size_t i, T* row) {
    put(points->here.places[i - points->first], row);
  });
}

/// Values of a column, vectors along grid axes widened to space.
FieldArray column_array(const Simulation& sim, const Column& c, const PointList& points) {
  const Frame frame = sim.scene().frame;
  FieldArray out;
  out.name = c.field->name;
  out.unit = c.field->unit;
  out.meaning = c.field->meaning;
  const bool is_vector = c.field->components == kPerAxis;
  out.components = is_vector ? 3 : c.components;
  if (is_vector) out.component_names = vector_names(frame);
  if (c.components == 6) out.component_names = tensor_names(frame);
  const int slot = c.offset / kLanes, components = c.components;
  out.values = rows_of<double>(points, out.components, [=](PointPlace at, double* row) {
    if (is_vector) std::fill_n(row, 3, 0.0);
    for (int k = 0; k < components; ++k) row[is_vector ? tensor_axis(frame, k) : k] = at(slot + k);
  });
  return out;
}

void add_stress(const Simulation& sim, const Body& body, const PointList& points, BodyFrame& out) {
  const int s = body.slot(field::DeviatoricStress::info), p = body.slot(field::Pressure::info);
  if (s < 0) return;
  const auto stress = [=](PointPlace at, double* row) {
    const double pressure = p < 0 ? 0 : at(p);
    for (int k = 0; k < 6; ++k) row[k] = at(s + k) - (k < 3 ? pressure : 0);
  };
  const auto mises = [=](PointPlace at, double* row) {
    *row = std::sqrt(1.5 * squared_deviator(at, s));
  };
  out.fields.push_back({"stress", "Pa", "Cauchy stress, tension positive, without viscosity", 6,
                        tensor_names(sim.scene().frame), rows_of<double>(points, 6, stress)});
  out.fields.push_back({"von_mises",
                        "Pa",
                        "von Mises stress sqrt(3/2 s:s)",
                        1,
                        {},
                        rows_of<double>(points, 1, mises)});
}

/// Which sets of a body: elements and the points that they became are drawn apart.
enum class DrawnSets { all, elements, points };

std::shared_ptr<DrawnPoints> points_at_hand(const Simulation& sim, int body, DrawnSets part) {
  auto points = std::make_shared<DrawnPoints>();
  for (const auto& [set, i] : sim.points_by_id(body)) {
    if (part != DrawnSets::all && sim.is_mesh_set(set) != (part == DrawnSets::elements)) continue;
    points->here.places.push_back({sim.set(set).points->point(i)});
    points->here.levels.push_back(sim.geometry_of(set).level);
  }
  return points;
}

/// A vector along grid axes, in space.
void widen(Frame frame, const Triple& v, double* row) {
  std::fill_n(row, 3, 0.0);
  for (int a = 0; a < dimension(frame); ++a)
    row[tensor_axis(frame, a)] = v[static_cast<std::size_t>(a)];
}

FrameMesh frame_mesh(const Simulation& sim, int s) {
  const MeshStep& step = *sim.mesh();
  const Mesh& mesh = step.mesh(s);
  const Frame frame = sim.scene().frame;
  FrameMesh out;
  out.nodes = step.node_count(s);
  out.corners = mesh.corners();
  const auto order = std::make_shared<std::vector<std::pair<int, int>>>(
      sim.points_by_id(sim.set(s).body));  // of the rows; eroded bodies keep no order
  out.connectivity = [&mesh, order](std::size_t first, std::size_t count, std::int64_t* to) {
    const auto corners = static_cast<std::size_t>(mesh.corners());
    for (std::size_t row = first; row < first + count; ++row)
      to = std::copy_n(
          mesh.elements.data() + static_cast<std::size_t>((*order)[row].second) * corners, corners,
          to);
  };
  out.coordinates = numbered_rows<double>(
      3, [&step, s, frame](std::size_t n, double* row) { widen(frame, step.position(s, n), row); });
  const auto velocity = [&step, s, frame](std::size_t n, double* row) {
    widen(frame, step.velocity(s, n), row);
  };
  const auto mass = [&step, s](std::size_t n, double* row) { *row = step.mass(s, n); };
  out.fields.push_back({"velocity", "m/s", "velocity of the node", 3, vector_names(frame),
                        numbered_rows<double>(3, velocity)});
  out.fields.push_back(
      {"mass", "kg", "its share of its elements", 1, {}, numbered_rows<double>(1, mass)});
  return out;
}

/// The level of the cells about each point.
FieldArray level_field(const PointList& points) {
  return {"level",
          "1",
          "of the cells about the point, which are 2^-level grid.cell wide",
          1,
          {},
          numbered_rows<double>(1, [points](std::size_t i, double* to) {
            *to = points->here.levels[i - points->first];
          })};
}

/// How far points are stretched, and which have lost a side (simulation/torn_points.hpp).
void add_fracture(const Simulation& sim, int body, BodyFrame& out) {
  const auto all = std::make_shared<const FractureOfPoints>(fracture_of(sim, body));
  out.fields.push_back({"grid_stretch",
                        "1",
                        "distance of what were neighbours over the reach of the shape function",
                        1,
                        {},
                        [all](std::size_t first, std::size_t count, double* to) {
                          std::copy_n(all->stretch.data() + first, count, to);
                        }});
  out.fields.push_back(
      {"torn",
       "1",
       "1: sound, but no point of its body is left on one side (numerical fracture)",
       1,
       {},
       [all](std::size_t first, std::size_t count, double* to) {
         for (std::size_t k = 0; k < count; ++k) to[k] = all->torn[first + k] ? 1.0 : 0.0;
       }});
}

BodyFrame body_frame(const Simulation& sim, int b, DrawnSets part) {
  const Body& body = *sim.bodies()[static_cast<std::size_t>(b)];
  const Frame frame = sim.scene().frame;
  BodyFrame out;
  out.body = body.name() + (part == DrawnSets::points ? kPointsOf : "");
  std::shared_ptr<DrawnPoints> drawn;
  if (sim.has_all_points()) {
    drawn = points_at_hand(sim, b, part);
    out.points = drawn->here.places.size();
  } else {
    drawn = std::make_shared<DrawnPoints>();
    out.points = sim.point_count(b);
    out.bring = [drawn, &sim, b](std::size_t first, std::size_t count) {
      drawn->first = first;
      drawn->here = sim.bring(b, first, count);
    };
  }
  const PointList points = drawn;
  const int id = body.slot(field::Id::info), x = body.slot(field::Position::info);
  out.ids = rows_of<std::int64_t>(points, 1, [id](PointPlace at, std::int64_t* row) {
    *row = static_cast<std::int64_t>(at(id));
  });
  out.coordinates = rows_of<double>(points, 3, [x, frame](PointPlace at, double* row) {
    Triple place{};
    for (int a = 0; a < dimension(frame); ++a) place[static_cast<std::size_t>(a)] = at(x + a);
    widen(frame, place, row);
  });
  for (const Column& c : body.layout().columns())
    if (!is_internal(c.field->name) || asked_for(sim.scene(), c.field->name))
      out.fields.push_back(column_array(sim, c, points));
  add_stress(sim, body, points, out);
  if (!sim.scene().grid.refine.empty() && body.options().material_points())
    out.fields.push_back(level_field(points));
  if (sim.scene().method.numerical_fracture != NumericalFracture::ignore &&
      body.options().material_points() && !body.options().rigid())
    add_fracture(sim, b, out);
  for (int s = 0; s < sim.set_count() && part != DrawnSets::points; ++s)
    if (sim.set(s).body == b && sim.is_mesh_set(s)) out.mesh = frame_mesh(sim, s);
  if (!asked_for(sim.scene(), kFragmentField)) return out;
  auto numbers = fragment_numbers(sim, b);  // elements come first
  if (part == DrawnSets::points)
    numbers.erase(numbers.begin(), numbers.end() - static_cast<std::ptrdiff_t>(out.points));
  const auto pieces = std::make_shared<const std::vector<double>>(std::move(numbers));
  out.fields.push_back({kFragmentField,
                        "1",
                        "connected piece of its body, 0 the heaviest",
                        1,
                        {},
                        [pieces](std::size_t first, std::size_t count, double* to) {
                          std::copy_n(pieces->data() + first, count, to);
                        }});
  return out;
}

}  // namespace

OutputFrame make_frame(const Simulation& sim, int number) {
  OutputFrame out;
  out.number = number;
  out.time = sim.time();
  out.step = sim.steps();
  for (std::size_t b = 0; b < sim.bodies().size(); ++b) {
    const int body = static_cast<int>(b);
    const bool apart = sim.bodies()[b]->options().becomes_points();
    out.bodies.push_back(body_frame(sim, body, apart ? DrawnSets::elements : DrawnSets::all));
    if (apart) out.bodies.push_back(body_frame(sim, body, DrawnSets::points));
  }
  return out;
}

}  // namespace krater
