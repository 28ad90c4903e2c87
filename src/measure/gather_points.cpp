// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>

#include "krater/core/parallel.hpp"
#include "krater/measure/measurements.hpp"
#include "krater/measure/pieces.hpp"

namespace krater {

namespace {

/// A scalar that is wanted, and its slot in every body of a selection (-1: not carried).
struct WantedScalar {
  std::vector<double>* values;
  int slot;
};

bool carried(const Body& body, const std::string& field) {
  const std::vector<Column>& columns = body.layout().columns();
  return std::any_of(columns.begin(), columns.end(),
                     [&](const Column& c) { return c.components == 1 && field == c.field->name; });
}

int slot_of(const Body& body, const std::string& field) {
  for (const Column& c : body.layout().columns())
    if (field == c.field->name) return c.offset / kLanes;
  return -1;
}

/// Of the wanted scalars those that all bodies carry; all of these where one is missing, for the
/// message to the user.
std::vector<std::string> available(const Simulation& sim, const std::vector<int>& bodies,
                                   const std::vector<std::string>& fields) {
  const auto by_all = [&](const std::string& field) {
    return std::all_of(bodies.begin(), bodies.end(), [&](int b) {
      return carried(*sim.bodies()[static_cast<std::size_t>(b)], field);
    });
  };
  std::vector<std::string> out;
  bool missing = false;
  for (const std::string& field : fields) {
    if (by_all(field) || field == "failed")
      out.push_back(field);
    else
      missing = true;
  }
  if (!missing || bodies.empty()) return out;
  for (const Column& c : sim.bodies()[static_cast<std::size_t>(bodies.front())]->layout().columns())
    if (by_all(c.field->name)) out.emplace_back(c.field->name);
  return out;
}

/// Cells about the points of bodies: the least or the greatest level of them.
int level_of(const Simulation& sim, const std::vector<int>& bodies, bool finest) {
  int level = -1;
  for (const Patch& patch : sim.grid().patches()) {
    if (std::find(bodies.begin(), bodies.end(), patch.body) == bodies.end()) continue;
    const int l = patch.key.level;
    level = level < 0 ? l : finest ? std::max(level, l) : std::min(level, l);
  }
  return std::max(level, 0);
}

/// A point of a lattice among the cells of `level` as those that it would be among those of
/// `finest`: their places from its own.
std::vector<Triple> parts_of(const Simulation& sim, int body, int level, int finest) {
  const GridGeometry& g = sim.geometry();
  const auto& per = sim.scene().bodies[static_cast<std::size_t>(body)].points.per_direction;
  const int along = 1 << (finest - level);
  std::vector<Triple> out{{}};
  for (std::size_t a = 0; a < static_cast<std::size_t>(g.dimension); ++a) {
    const double step = std::ldexp(g.h, -finest) / per[a];
    std::vector<Triple> more;
    for (const Triple& at : out)
      for (int k = 0; k < along; ++k) {
        more.push_back(at);
        more.back()[a] += (k + 0.5 * (1 - along)) * step;
      }
    out = std::move(more);
  }
  return out;
}

/// A component of all points, each `times` times in a row.
void copy_component(const PointStore& points, int slot, std::size_t times, double* to) {
  for (int g = 0; g < points.groups(); ++g) {
    const double* lanes = points.point(kLanes * g) + kLanes * slot;
    // Some lines of every record: the processor does not foresee it.
    __builtin_prefetch(lanes + 4 * points.stride());
    const int count = std::min(kLanes, points.count() - kLanes * g);
    if (times == 1 && count == kLanes) {
      to = std::copy_n(lanes, kLanes, to);
      continue;
    }
    for (int lane = 0; lane < count; ++lane) to = std::fill_n(to, times, lanes[lane]);
  }
}

void copy_vector(const PointStore& points, int slot, int dim, std::size_t times, Triple* to) {
  for (int g = 0; g < points.groups(); ++g) {
    const double* lanes = points.point(kLanes * g) + kLanes * slot;
    for (int a = 0; a < dim; ++a) __builtin_prefetch(lanes + kLanes * a + 4 * points.stride());
    const double* last = lanes + kLanes * (dim - 1);
    const int count = std::min(kLanes, points.count() - kLanes * g);
    for (int lane = 0; lane < count; ++lane)
      to = std::fill_n(to, times,
                       Triple{lanes[lane], lanes[kLanes + lane], dim == 3 ? last[lane] : 0.0});
  }
}

/// The points of a set into `out`, from the place `first` on; each in parts at these places from
/// its own. Column by column: a lane group's component is a line of the cache.
void gather_set(const Simulation& sim, int at, const std::vector<WantedScalar>& wanted,
                std::size_t first, const std::vector<Triple>& parts, BodyPoints& out) {
  const PointSet set = sim.set(at);
  const PointStore& points = *set.points;
  const Body& body = *sim.bodies()[static_cast<std::size_t>(set.body)];
  const int dim = sim.geometry().dimension;
  const std::size_t times = parts.size(),
                    end = first + times * static_cast<std::size_t>(set.count());
  copy_vector(points, body.slot(field::Position::info), dim, times, out.x.data() + first);
  copy_component(points, body.slot(field::Mass::info), times, out.mass.data() + first);
  copy_component(points, body.slot(field::Density::info), times, out.density.data() + first);
  for (std::size_t n = first; times > 1 && n < end; ++n) {
    for (std::size_t a = 0; a < 3; ++a) out.x[n][a] += parts[(n - first) % times][a];
    out.mass[n] /= static_cast<double>(times);
  }
  if (!out.v.empty())
    copy_vector(points, body.slot(field::Velocity::info), dim, times, out.v.data() + first);
  for (const WantedScalar& w : wanted) {
    double* const to = w.values->data() + first;
    if (w.slot < 0)
      std::fill_n(to, end - first, 0.0);
    else
      copy_component(points, w.slot, times, to);
  }
  if (out.body.empty()) return;
  const int failed = slot_of(body, field::Failed::info.name);
  const double loose = 0.5 * body.material().density;
  for (std::size_t n = first; n < end; ++n) {
    out.body[n] = set.body;
    out.rubble[n] = failed >= 0 && out.density[n] < loose &&
                    points.at(kLanes * failed, static_cast<int>((n - first) / times)) > 0.5;
  }
}

/// A point that part of an element became, beside the surface of the elements that are left: as
/// wide along each axis as a cube (a square of the section) of its volume, up to the domain's
/// sides.
void add_crosses(const Simulation& sim, int set, std::vector<std::array<Triple, 2>>& edges) {
  const PointSet p = sim.set(set);
  const Body& body = *sim.bodies()[static_cast<std::size_t>(p.body)];
  const int x = body.slot(field::Position::info), m = body.slot(field::Mass::info),
            rho = body.slot(field::Density::info), dim = sim.geometry().dimension;
  for (int i = 0; i < p.count(); ++i) {
    const double* point = p.points->point(i);
    Triple at{};
    for (int a = 0; a < dim; ++a) at[static_cast<std::size_t>(a)] = point[kLanes * (x + a)];
    double volume = point[kLanes * m] / point[kLanes * rho];
    if (sim.scene().frame == Frame::axisymmetric) volume /= 2 * std::numbers::pi * at[0];
    const double half = 0.5 * std::pow(volume, 1.0 / dim);
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
      std::array<Triple, 2> edge{at, at};
      const double low = sim.geometry().min[a], high = sim.geometry().upper(static_cast<int>(a));
      edge[0][a] = std::max(at[a] - half, std::min(at[a], low));
      edge[1][a] = std::min(at[a] + half, std::max(at[a], high));
      edges.push_back(edge);
    }
  }
}

}  // namespace

MeasureContext measure_context(const Simulation& sim, const std::vector<int>& bodies,
                               bool surface) {
  const Scene& scene = sim.scene();
  MeasureContext c;
  c.frame = scene.frame;
  c.h = sim.geometry().h;
  if (!scene.grid.refine.empty()) c.h = std::ldexp(c.h, -level_of(sim, bodies, surface));
  c.min = scene.grid.min;
  for (int a = 0; a < sim.geometry().dimension; ++a)
    c.max[static_cast<std::size_t>(a)] = sim.geometry().upper(a);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t s = 0; s < 2; ++s) {
      const Boundary& side = scene.grid.boundary[a][s];  // one that travels is gone from its place
      c.boundary[a][s] = side.mirrors(static_cast<int>(a)) ? side.kind : BoundaryKind::open;
    }
  // The widest spacing: a surface is told to that.
  c.points_per_direction = std::numeric_limits<int>::max();
  for (const int b : bodies) {
    const auto& per = scene.bodies[static_cast<std::size_t>(b)].points.per_direction;
    c.points_per_direction =
        std::min(c.points_per_direction,
                 *std::min_element(per.begin(), per.begin() + sim.geometry().dimension));
  }
  return c;
}

void gather_points(const Simulation& sim, const std::vector<int>& bodies, const GatherNeeds& needs,
                   BodyPoints& out) {
  struct SetPlace {
    int set;
    std::size_t first, body;  ///< its place among the points, and of its body in `bodies`
  };
  std::vector<SetPlace> places;
  std::size_t count = 0;
  const bool splits = needs.surface && !sim.scene().grid.refine.empty();
  const int finest = splits ? level_of(sim, bodies, true) : 0;
  const std::vector<Triple> whole{{}};
  std::map<std::pair<int, int>, std::vector<Triple>> parts;  // by body and level
  const auto parts_at = [&](int s) -> const std::vector<Triple>& {
    const int level = sim.geometry_of(s).level;
    if (!splits || level == finest) return whole;
    std::vector<Triple>& out_of = parts[{sim.set(s).body, level}];
    if (out_of.empty()) out_of = parts_of(sim, sim.set(s).body, level, finest);
    return out_of;
  };
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (int s = 0; s < sim.set_count(); ++s) {
      if (sim.set(s).body != bodies[b]) continue;
      places.push_back({s, count, b});
      count += static_cast<std::size_t>(sim.set(s).count()) * parts_at(s).size();
    }
  out.x.resize(count);
  out.v.resize(needs.velocity || needs.pieces ? count : 0);
  out.mass.resize(count);
  out.density.resize(count);
  out.body.resize(needs.pieces ? count : 0);
  out.rubble.resize(needs.pieces ? count : 0);
  const std::vector<std::string> names = available(sim, bodies, needs.fields);
  std::erase_if(out.scalars, [&](const auto& scalar) {
    return std::find(names.begin(), names.end(), scalar.first) == names.end();
  });
  for (const std::string& name : names) out.scalars[name].resize(count);
  std::vector<std::vector<WantedScalar>> wanted(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (auto& [name, values] : out.scalars)
      wanted[b].push_back(
          {&values, slot_of(*sim.bodies()[static_cast<std::size_t>(bodies[b])], name)});
  out.edges.clear();
  for (const SetPlace& place : places) {
    if (!sim.is_mesh_set(place.set)) {
      if (sim.is_mesh(bodies[place.body])) add_crosses(sim, place.set, out.edges);
      continue;
    }
    for (const auto& [a, b] : sim.mesh()->surface(place.set))
      out.edges.push_back({sim.mesh()->position(place.set, static_cast<std::size_t>(a)),
                           sim.mesh()->position(place.set, static_cast<std::size_t>(b))});
  }
  for_each(places.size(), [&](std::size_t i) {
    const auto found =
        parts.find({sim.set(places[i].set).body, sim.geometry_of(places[i].set).level});
    gather_set(sim, places[i].set, wanted[places[i].body], places[i].first,
               found == parts.end() ? whole : found->second, out);
  });
}

BodyPoints gather_points(const Simulation& sim, const std::vector<int>& bodies,
                         const GatherNeeds& needs) {
  BodyPoints points;
  gather_points(sim, bodies, needs, points);
  return points;
}

std::vector<double> fragment_numbers(const Simulation& sim, int body) {
  const BodyPoints points = gather_points(sim, {body}, {.pieces = true});
  const Pieces pieces = connected_pieces(points, measure_context(sim, {body}));
  std::vector<int> first;  // of every set among the points
  int count = 0;
  for (int s = 0; s < sim.set_count(); ++s) {
    first.push_back(count);
    if (sim.set(s).body == body) count += sim.set(s).count();
  }
  std::vector<double> out;
  for (const auto& [s, i] : sim.points_by_id(body))
    out.push_back(pieces.of[static_cast<std::size_t>(first[static_cast<std::size_t>(s)] + i)]);
  return out;
}

}  // namespace krater
