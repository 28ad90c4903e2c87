// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/core/parallel.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

const char* text_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::not_finite_input:
      return "not finite before the step, or outside its block";
    case FaultKind::not_finite_velocity:
      return "grid velocity not finite";
    case FaultKind::inverted:
      return "turned inside out (det f <= 0)";
    case FaultKind::not_finite_state:
      return "stress, pressure, energy or sound speed not finite after the update";
    case FaultKind::no_convergence:
      return "constitutive update did not converge";
    case FaultKind::moved_too_far:
      return "moved by more than a block in one step";
    case FaultKind::none:
      break;
  }
  return "unknown";
}

std::size_t Simulation::point_count() const {
  std::size_t n = 0;
  for (int s = 0; s < first_points(); ++s) n += static_cast<std::size_t>(set(s).count());
  for (const Patch& patch : grid_.patches()) n += static_cast<std::size_t>(patch.count());
  return n;
}

int Simulation::count_of(int s) const {
  return s < first_points() ? set(s).count()
                            : grid_.patches()[static_cast<std::size_t>(s - first_points())].count();
}

std::size_t Simulation::point_count(int body) const {
  std::size_t n = 0;
  for (const int s : sets_of(body)) n += static_cast<std::size_t>(count_of(s));
  return n;
}

double Simulation::bytes_per_point() const {
  double doubles = 0, points = 0;
  for (const Patch& p : grid_.patches()) {
    points += p.here ? p.points.count() : 0;
    doubles += static_cast<double>(p.points.capacity() + p.tile.nodes.size() + p.beta.size()) +
               sizeof(Patch) / 8.0;
  }
  doubles += static_cast<double>(grid_.node_blocks().size()) * kBlockNodes * kNodeDoubles;
  if (mesh_) doubles += static_cast<double>(mesh_->memory()) / 8;
  if (sph_) doubles += static_cast<double>(sph_->memory()) / 8;
  for (int s = 0; s < first_points(); ++s) points += set(s).count();
  return 8 * doubles / std::max(points, 1.0);  // of this rank
}

void Simulation::set_value(int s, int point, int slot, double x) {
  seen_.clear();
  change(s).at(kLanes * slot, point) = x;
}

void Simulation::book_change() {
  if (sph_) sph_->find_forces();
  if (mesh_) mesh_->find_forces();
  const Totals now = totals();
  audit_.external_work += now.kinetic + now.internal - (audit_.kinetic + audit_.internal);
  audit_.kinetic = now.kinetic;
  audit_.internal = now.internal;
}

std::vector<std::pair<int, int>> Simulation::points_by_id(int body) const {
  const int slot = bodies_[static_cast<std::size_t>(body)]->slot(field::Id::info);
  std::vector<std::pair<double, std::pair<int, int>>> order;
  for (int s = 0; s < set_count(); ++s) {
    if (set(s).body != body) continue;
    for (int i = 0; i < set(s).count(); ++i) order.push_back({value(s, i, slot), {s, i}});
  }
  std::sort(order.begin(), order.end());
  std::vector<std::pair<int, int>> out;
  out.reserve(order.size());
  for (const auto& entry : order) out.push_back(entry.second);
  return out;
}

/// The velocity fields of bodies, each once: one for all of them where they have no contact.
std::vector<FieldId> Simulation::fields_of(const std::vector<int>& bodies) const {
  if (!scene_.contact.active) return {FieldId{}};
  std::vector<FieldId> out;
  for (const int b : bodies) out.push_back(own_field(b));
  return out;
}

Triple Simulation::impulse(const std::vector<int>& bodies, Partner by) const {
  Triple sum{};
  for (const FieldId on : fields_of(bodies)) {
    const Triple more = impulses_.of(on, by);
    for (std::size_t a = 0; a < 3; ++a) sum[a] += more[a];
  }
  return sum;
}

std::string Simulation::describe_point(int s, int point) const {
  const Body& body = *bodies_[static_cast<std::size_t>(set(s).body)];
  std::string position;
  for (int a = 0; a < geometry_.dimension; ++a)
    position += fmt::format("{}{} = {:.6e} m", a > 0 ? ", " : "", axis_name(scene_.frame, a),
                            value(s, point, body.slot(field::Position::info, a)));
  return fmt::format("body '{}', {} {:.0f} at {}", body.name(),
                     s < mesh_sets()      ? "element"
                     : s < first_points() ? "particle"
                                          : "point",
                     value(s, point, body.slot(field::Id::info)), position);
}

double Simulation::energy_per_mass(int s, int point) const {
  const Body& body = *bodies_[static_cast<std::size_t>(set(s).body)];
  double energy = 0;
  if (s < first_points()) {
    for (int a = 0; a < geometry_.dimension; ++a) {
      const double v = value(s, point, body.slot(field::Velocity::info, a));
      energy += 0.5 * v * v;
    }
  } else {
    const PointColumns& c = kernel_data_[static_cast<std::size_t>(set(s).body)].columns;
    energy = point_kinetic(set(s).points->point(point), c, geometry_of(s)) /
             value(s, point, c.mass / kLanes);
  }
  const int e = body.slot(field::InternalEnergy::info);
  return e < 0 ? energy : energy + value(s, point, e);
}

/// The point with the greatest energy per mass.
std::string Simulation::describe_hottest() const {
  double greatest = -1;
  std::pair<int, int> where{0, 0};
  for (int s = 0; s < set_count(); ++s)
    for (int i = 0; i < set(s).count(); ++i) {
      const double energy = energy_per_mass(s, i);
      if (std::isnan(energy)) return describe_point(s, i) + ", which is not finite";
      if (energy <= greatest) continue;
      greatest = energy;
      where = {s, i};
    }
  return fmt::format("most per mass, {:.4g} J/kg, at {}", greatest,
                     describe_point(where.first, where.second));
}

std::string Simulation::describe_fault(int s, const Fault& fault) const {
  int lane = 0;
  while (lane < kLanes - 1 && ((fault.lanes >> lane) & 1U) == 0) ++lane;
  const int point = std::min(kLanes * fault.group + lane, set(s).count() - 1);
  std::string field = "all fields finite";
  for (const Column& c : bodies_[static_cast<std::size_t>(set(s).body)]->layout().columns())
    for (int k = 0; k < c.components && field == "all fields finite"; ++k) {
      const double x = value(s, point, c.offset / kLanes + k);
      if (!std::isfinite(x))
        field = fmt::format("field '{}' component {} is {}", c.field->name, k, x);
    }
  return fmt::format("{}: {}; {}; time {:.6e} s, step {}", describe_point(s, point),
                     text_of(fault.kind), field, time(), steps());
}

std::vector<int> Simulation::sets_of(int body) const {
  std::vector<int> out;
  for (int s = 0; s < set_count(); ++s)
    if (set(s).body == body) out.push_back(s);
  return out;
}

}  // namespace krater
