// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <set>

#include "krater/core/parallel.hpp"
#include "krater/measure/measurements.hpp"

namespace krater {

namespace {

/// Where a point is, and its components by slot.
struct Place {
  const double* point;
  double operator()(int slot) const { return point[kLanes * slot]; }
};
using PointList = std::shared_ptr<const std::vector<Place>>;

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
  return numbered_rows<T>(width, [points, put](std::size_t i, T* row) { put((*points)[i], row); });
}

/// s:s of the deviator from slot `s` on.
double squared_deviator(Place at, int s) {
  double square = 0;
  for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * at(s + k) * at(s + k);
  return square;
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
  out.values = rows_of<double>(points, out.components, [=](Place at, double* row) {
    if (is_vector) std::fill_n(row, 3, 0.0);
    for (int k = 0; k < components; ++k) row[is_vector ? tensor_axis(frame, k) : k] = at(slot + k);
  });
  return out;
}

void add_stress(const Simulation& sim, const Body& body, const PointList& points, BodyFrame& out) {
  const int s = body.slot(field::DeviatoricStress::info), p = body.slot(field::Pressure::info);
  if (s < 0) return;
  const auto stress = [=](Place at, double* row) {
    const double pressure = p < 0 ? 0 : at(p);
    for (int k = 0; k < 6; ++k) row[k] = at(s + k) - (k < 3 ? pressure : 0);
  };
  const auto mises = [=](Place at, double* row) {
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

PointList places_by_id(const Simulation& sim, int body) {
  auto places = std::make_shared<std::vector<Place>>();
  for (const auto& [set, i] : sim.points_by_id(body))
    places->push_back({sim.set(set).points->point(i)});
  return places;
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

BodyFrame body_frame(const Simulation& sim, int b) {
  const Body& body = *sim.bodies()[static_cast<std::size_t>(b)];
  const Frame frame = sim.scene().frame;
  const PointList points = places_by_id(sim, b);
  BodyFrame out;
  out.body = body.name();
  out.points = points->size();
  const int id = body.slot(field::Id::info), x = body.slot(field::Position::info);
  out.ids = rows_of<std::int64_t>(
      points, 1, [id](Place at, std::int64_t* row) { *row = static_cast<std::int64_t>(at(id)); });
  out.coordinates = rows_of<double>(points, 3, [x, frame](Place at, double* row) {
    Triple place{};
    for (int a = 0; a < dimension(frame); ++a) place[static_cast<std::size_t>(a)] = at(x + a);
    widen(frame, place, row);
  });
  for (const Column& c : body.layout().columns())
    if (!is_internal(c.field->name) || asked_for(sim.scene(), c.field->name))
      out.fields.push_back(column_array(sim, c, points));
  add_stress(sim, body, points, out);
  if (body.options().mesh)
    for (int s = 0; s < sim.set_count(); ++s)
      if (sim.set(s).body == b) out.mesh = frame_mesh(sim, s);
  if (!asked_for(sim.scene(), kFragmentField)) return out;
  const auto pieces = std::make_shared<const std::vector<double>>(fragment_numbers(sim, b));
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

void add(std::vector<Quantity>& row, std::string name, std::string unit, double value) {
  row.push_back({std::move(name), std::move(unit), value});
}

/// Elastic energy of the deviator, sum m s:s/(4 G (1 - phi) rho) [J], of one set.
double deviatoric_energy(const Simulation& sim, int set) {
  const PointSet points = sim.set(set);
  const Body& body = *sim.bodies()[static_cast<std::size_t>(points.body)];
  const int s = body.slot(field::DeviatoricStress::info), m = body.slot(field::Mass::info),
            rho = body.slot(field::Density::info),
            phi = body.degrades() ? body.slot(field::Damage::info) : -1;
  const double G = body.material().shear_modulus;
  if (s < 0 || G <= 0) return 0;
  double sum = 0;
  for (int i = 0; i < points.count(); ++i) {
    const Place at{points.points->point(i)};
    sum += at(m) * squared_deviator(at, s) / (4 * G * at(rho) * (phi < 0 ? 1 : 1 - at(phi)));
  }
  return sum;
}

double deviatoric_energy(const Simulation& sim) {
  std::vector<double> sets(static_cast<std::size_t>(sim.set_count()));
  for_each(sets.size(),
           [&](std::size_t s) { sets[s] = deviatoric_energy(sim, static_cast<int>(s)); });
  return std::accumulate(sets.begin(), sets.end(), 0.0);
}

void add_elements(const Simulation& sim, std::vector<Quantity>& row) {
  add(row, "hourglass_energy", "J", sim.elements().hourglass);
  add(row, "folded_elements", "1", static_cast<double>(sim.elements().folded));
  add(row, "eroded_elements", "1", sim.mesh()->eroded().all());
}

void add_elements(const Simulation& sim, Json& j) {
  const MeshHealth& mesh = sim.elements();
  j["hourglass_energy"] = Json::of(mesh.hourglass);
  j["hourglass_share"] = Json::of(mesh.hourglass_share());
  j["folded_elements"] = Json::of(static_cast<std::int64_t>(mesh.folded));
  j["most_folded_elements"] = Json::of(static_cast<std::int64_t>(sim.audit().most_folded));
  j["least_corner_jacobian"] = Json::of(mesh.least_corner);
  const Eroded eroded = sim.mesh()->eroded();
  j["eroded_elements"] = Json::of(static_cast<std::int64_t>(eroded.all()));
  if (!(eroded.all() > 0)) return;
  Json& causes = j["eroded_by"];
  for (std::size_t k = 0; k < Eroded::parts.size(); ++k)
    causes[Eroded::names[k]] = Json::of(static_cast<std::int64_t>(eroded.*Eroded::parts[k]));
}

void add_particles(const Simulation& sim, std::vector<Quantity>& row) {
  if (sim.sph() == nullptr) return;
  add(row, "uncorrected_particles", "1", static_cast<double>(sim.sph()->flat_count()));
  add(row, "stabilisation_heat", "J", sim.audit().stabilisation);
}

void add_particles(const Simulation& sim, Json& j) {
  if (sim.sph() == nullptr) return;
  j["uncorrected_particles"] = Json::of(static_cast<std::int64_t>(sim.sph()->flat_count()));
  j["stabilisation_heat"] = Json::of(sim.audit().stabilisation);
}

}  // namespace

OutputFrame make_frame(const Simulation& sim, int number) {
  OutputFrame out;
  out.number = number;
  out.time = sim.time();
  out.step = sim.steps();
  for (std::size_t b = 0; b < sim.bodies().size(); ++b)
    out.bodies.push_back(body_frame(sim, static_cast<int>(b)));
  return out;
}

std::vector<Quantity> history_row(const Simulation& sim) {
  const Audit& a = sim.audit();
  const std::vector<Totals> bodies = sim.totals_by_body();
  Totals t;
  for (const Totals& body : bodies) t += body;
  std::vector<Quantity> row;
  add(row, "time", "s", sim.time());
  add(row, "step", "1", static_cast<double>(sim.steps()));
  add(row, "dt", "s", sim.dt());
  add(row, "dt_limiter", "1", sim.limiter_kind());
  add(row, "kinetic_energy", "J", t.kinetic);
  add(row, "internal_energy", "J", t.internal);
  add(row, "total_energy", "J", t.kinetic + t.internal);
  add(row, "deviatoric_elastic_energy", "J", deviatoric_energy(sim));
  add(row, "plastic_work", "J", a.plastic_work);
  add(row, "viscous_work", "J", a.viscous_work);
  add(row, "transfer_loss", "J", a.transfer_loss);
  add(row, "transfer_gain", "J", a.transfer_gain);
  add(row, "numerical_heat", "J", a.numerical_heat);
  add(row, "carried_energy", "J", a.carried);
  add(row, "wall_heat", "J", a.wall_heat);
  add(row, "wall_work", "J", a.wall_work);
  add(row, "contact_heat", "J", a.contact_heat);
  add(row, "friction_work", "J", a.friction_work);
  add(row, "external_work", "J", a.external_work);
  add(row, "removed_energy", "J", a.removed_energy);
  add(row, "energy_residual", "J", a.residual(t.kinetic, t.internal));
  add(row, "energy_error_fraction", "1", a.error_fraction());
  if (sim.mesh() != nullptr) add_elements(sim, row);
  add_particles(sim, row);
  add(row, "mass", "kg", t.mass);
  const Frame frame = sim.scene().frame;
  for (int k = 0; k < dimension(frame); ++k)
    add(row, "momentum_" + std::string{axis_name(frame, k)}, "kg m/s",
        t.momentum[static_cast<std::size_t>(k)]);
  for (int k = 0; k < dimension(frame); ++k)
    add(row, "wall_impulse_" + std::string{axis_name(frame, k)}, "N s",
        a.wall_impulse[static_cast<std::size_t>(k)]);
  for (int k = 0; k < dimension(frame); ++k)
    add(row, "external_impulse_" + std::string{axis_name(frame, k)}, "N s",
        a.external_impulse[static_cast<std::size_t>(k)]);
  add(row, "angular_momentum", "kg m^2/s", t.angular_momentum);
  add(row, "removed_points", "1", a.removed_points);
  add(row, "removed_mass", "kg", a.removed_mass);
  add(row, "wall_columns", "1", a.wall_columns);
  add(row, "contact_pairs", "1", a.contact_pairs);
  for (std::size_t b = 0; b < sim.bodies().size(); ++b) {
    const Totals& body = bodies[b];
    add(row, sim.bodies()[b]->name() + ".kinetic_energy", "J", body.kinetic);
    for (int k = 0; k < dimension(frame); ++k)
      add(row, sim.bodies()[b]->name() + ".mean_velocity_" + std::string{axis_name(frame, k)},
          "m/s", body.mass > 0 ? body.momentum[static_cast<std::size_t>(k)] / body.mass : 0.0);
    const RigidBody* rigid = sim.rigid().find(static_cast<int>(b));
    for (int k = 0; rigid && k < dimension(frame); ++k)
      add(row, sim.bodies()[b]->name() + ".contact_impulse_" + std::string{axis_name(frame, k)},
          "N s", rigid->received()[k]);
  }
  return row;
}

Json audit_json(const Simulation& sim) {
  const Audit& a = sim.audit();
  const Totals t = sim.totals();
  Json j;
  const double start = a.initial_kinetic + a.initial_internal,
               residual = a.residual(t.kinetic, t.internal);
  j["initial_energy"] = Json::of(start);
  j["kinetic_energy"] = Json::of(t.kinetic);
  j["internal_energy"] = Json::of(t.internal);
  j["plastic_work"] = Json::of(a.plastic_work);
  j["viscous_work"] = Json::of(a.viscous_work);
  j["external_work"] = Json::of(a.external_work);
  j["load_work"] = Json::of(a.load_work);
  j["damping_work"] = Json::of(a.damping_work);
  j["wall_work"] = Json::of(a.wall_work);
  j["wall_heat"] = Json::of(a.wall_heat);
  j["contact_heat"] = Json::of(a.contact_heat);
  j["friction_work"] = Json::of(a.friction_work);
  j["transfer_loss"] = Json::of(a.transfer_loss);
  j["transfer_gain"] = Json::of(a.transfer_gain);
  j["numerical_heat"] = Json::of(a.numerical_heat);
  j["carried_energy"] = Json::of(a.carried);
  j["largest_carried_energy"] = Json::of(a.largest_carried);
  if (sim.mesh() != nullptr) add_elements(sim, j);
  add_particles(sim, j);
  j["removed_energy"] = Json::of(a.removed_energy);
  j["energy_residual"] = Json::of(residual);
  j["energy_residual_fraction"] = Json::of(start > 0 ? residual / start : residual);
  j["energy_error_fraction"] = Json::of(a.error_fraction());
  j["mass"] = Json::of(t.mass);
  j["removed_mass"] = Json::of(a.removed_mass);
  const std::pair<const char*, const Triple&> momenta[] = {
      {"momentum_", t.momentum},
      {"wall_impulse_", a.wall_impulse},
      {"external_impulse_", a.external_impulse},
      {"load_impulse_", a.load_impulse},
      {"damping_impulse_", a.damping_impulse},
      {"removed_momentum_", a.removed_momentum}};
  for (const auto& [name, value] : momenta)
    for (int k = 0; k < dimension(sim.scene().frame); ++k)
      j[name + std::string{axis_name(sim.scene().frame, k)}] =
          Json::of(value[static_cast<std::size_t>(k)]);
  j["angular_momentum"] = Json::of(t.angular_momentum);
  Json events;
  events["removed_points"] = Json::of(static_cast<std::int64_t>(a.removed_points));
  events["removed_failed_points"] = Json::of(static_cast<std::int64_t>(a.removed_failed));
  events["sound_speed_floors"] = Json::of(static_cast<std::int64_t>(a.sound_speed_floors));
  events["hugoniot_poles"] = Json::of(static_cast<std::int64_t>(a.hugoniot_poles));
  events["failures"] = Json::of(static_cast<std::int64_t>(a.failures));
  events["snap_backs"] = Json::of(static_cast<std::int64_t>(a.snap_backs));
  events["spalls"] = Json::of(static_cast<std::int64_t>(a.spalls));
  events["new_references"] = Json::of(static_cast<std::int64_t>(a.new_references));
  events["carriers"] = Json::of(static_cast<std::int64_t>(a.carriers));
  events["reflections"] = Json::of(static_cast<std::int64_t>(a.reflections));
  events["penetrations"] = Json::of(static_cast<std::int64_t>(a.penetrations));
  events["deepest_reflection_cells"] = Json::of(a.deepest_reflection);
  events["halved_steps"] = Json::of(static_cast<std::int64_t>(a.retries));
  j["events"] = events;
  return j;
}

}  // namespace krater
