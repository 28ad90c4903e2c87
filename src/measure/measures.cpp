// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "krater/core/errors.hpp"
#include "krater/measure/attitude.hpp"
#include "krater/measure/measure_surface.hpp"
#include "krater/measure/openings.hpp"
#include "krater/measure/pieces.hpp"

namespace krater {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// sum m q(p)
template <class Q>
double sum(const BodyPoints& body, const Q& q) {
  double total = 0;
  for (std::size_t p = 0; p < body.count(); ++p) total += body.mass[p] * q(p);
  return total;
}

double mass(const BodyPoints& body) {
  return sum(body, [](std::size_t) { return 1.0; });
}

double along(const MeasureOptions& measure, const Triple& v) {
  const Triple d = direction_of(measure);
  return v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
}

double momentum(const MeasureOptions& measure, const BodyPoints& body) {
  const Triple d = direction_of(measure);
  return sum(body, [&](std::size_t p) {
    const Triple& v = body.v[p];
    return v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
  });
}

double kinetic_energy(const BodyPoints& body) {
  return 0.5 * sum(body, [&](std::size_t p) {
           const Triple& v = body.v[p];
           return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
         });
}

const std::vector<double>& scalar(const MeasureOptions& measure, const BodyPoints& body,
                                  const std::string& field) {
  const auto found = body.scalars.find(field);
  if (found != body.scalars.end()) return found->second;
  std::string carried;
  for (const auto& [name, values] : body.scalars) carried += (carried.empty() ? "" : ", ") + name;
  throw InputError(measure.where + ": the body carries no field '" + field + "' (it carries " +
                   (carried.empty() ? "none" : carried) + ")");
}

double total(const BodyPoints& body, const std::vector<double>& values) {
  return sum(body, [&](std::size_t p) { return values[p]; });
}

/// Only materials that can fail carry the field.
double failed_mass(const BodyPoints& body) {
  const auto failed = body.scalars.find("failed");
  return failed == body.scalars.end() ? 0.0 : total(body, failed->second);
}

/// Sums in another order differ in their last bits: that is no loss.
double removed_mass(const BodyPoints& body, const MeasureStart& start) {
  const double gone = start.mass - mass(body);
  return std::abs(gone) > 1e-12 * start.mass ? gone : 0.0;
}

/// Least q with sum of the weights of all not greater >= wanted, in linear time: a weighted
/// quickselect.
double weighted_quantile(std::vector<std::pair<double, double>> items, double wanted) {
  auto low = items.begin(), high = items.end();
  double below = 0;  // weight of the items before `low`
  while (high - low > 1) {
    const auto middle = low + (high - low) / 2;
    std::nth_element(low, middle, high);
    double left = 0;
    for (auto i = low; i != middle; ++i) left += i->second;
    if (below + left >= wanted) {
      high = middle;
    } else {
      below += left;
      low = middle;
    }
  }
  return low->first;
}

double debris_extent(const MeasureOptions& measure, const BodyPoints& body,
                     const MeasureContext& context) {
  const int axis = measure.axis;
  const bool below = is_symmetry(context, axis, 0), above = is_symmetry(context, axis, 1);
  const double plane = below ? context.min[index(axis)] : context.max[index(axis)];
  const double spacing = node_spacing(context) / 2;
  std::vector<std::pair<double, double>> items;
  items.reserve(body.count());
  for (std::size_t p = 0; p < body.count(); ++p) {
    const double x = body.x[p][index(axis)];
    items.emplace_back(below || above ? std::abs(x - plane) : x, body.mass[p]);
  }
  // A sum in another order must not fall short of all the mass.
  const double all = mass(body) * (1 - 1e-12), s = measure.mass_share;
  if (below || above) return 2 * weighted_quantile(items, s * all) + spacing;
  const double low = weighted_quantile(items, (1 - s) / 2 * all);
  return weighted_quantile(items, (1 + s) / 2 * all) - low + spacing;
}

double penetration_depth(const MeasureOptions& measure, const BodyPoints& body,
                         const MeasureContext& context, const MeasureStart& start) {
  const double front = outermost(body, context, measure.axis, 1 - measure.side);
  return measure.side == 1 ? start.face - front : front - start.face;
}

double bulge(const MeasureOptions& measure, const BodyPoints& body, const MeasureContext& context,
             const MeasureStart& start) {
  const double top = outermost(body, context, measure.axis, measure.side);
  return measure.side == 1 ? top - start.face : start.face - top;
}

/// Side 1: the largest value that points of a share of the mass reach; 0: the smallest. One point
/// is no answer: its value grows without limit as the cell falls (overshoot beside the axis).
double extreme(const MeasureOptions& measure, const BodyPoints& body, int side) {
  const std::vector<double>& values = scalar(measure, body, measure.field);
  const double sign = side == 1 ? -1 : 1;
  std::vector<std::pair<double, double>> items;
  items.reserve(body.count());
  for (std::size_t p = 0; p < body.count(); ++p) items.emplace_back(sign * values[p], body.mass[p]);
  return sign * weighted_quantile(items, measure.mass_share * mass(body) * (1 - 1e-12));
}

using Evaluate = double (*)(const MeasureOptions&, const BodyPoints&, const MeasureContext&,
                            const MeasureStart&);

struct Evaluator {
  MeasureKind kind;
  bool sums;  ///< defined for no points, too
  Evaluate evaluate;
};

#define KRATER_MEASURE(kind, sums, value)                                         \
  {                                                                               \
    MeasureKind::kind, sums,                                                      \
        [](const MeasureOptions& m, const BodyPoints& b, const MeasureContext& c, \
           const MeasureStart& s) -> double {                                     \
          (void)m, (void)b, (void)c, (void)s;                                     \
          return value;                                                           \
        }                                                                         \
  }

/// In the order of the enum (checked by the tests).
constexpr Evaluator kEvaluators[] = {
    KRATER_MEASURE(extent, false, extent(b, c, m.axis)),
    KRATER_MEASURE(max, false, outermost(b, c, m.axis, 1)),
    KRATER_MEASURE(min, false, outermost(b, c, m.axis, 0)),
    KRATER_MEASURE(diameter, false, diameter(b, c, m.at, m.at_from_end)),
    KRATER_MEASURE(largest_diameter, false, largest_diameter(b, c, m.level)),
    KRATER_MEASURE(mean_velocity, false, momentum(m, b) / mass(b)),
    KRATER_MEASURE(momentum, true, momentum(m, b)),
    KRATER_MEASURE(deceleration, false, momentum(m, b) / mass(b)),
    KRATER_MEASURE(settling_time, false, momentum(m, b) / mass(b)),
    KRATER_MEASURE(kinetic_energy, true, kinetic_energy(b)),
    KRATER_MEASURE(internal_energy, true, total(b, scalar(m, b, "internal_energy"))),
    KRATER_MEASURE(mass, true, mass(b)),
    KRATER_MEASURE(removed_mass, true, removed_mass(b, s)),
    KRATER_MEASURE(failed_mass, true, failed_mass(b)),
    KRATER_MEASURE(mass_lost, true, removed_mass(b, s) + failed_mass(b)),
    KRATER_MEASURE(mean, false, total(b, scalar(m, b, m.field)) / mass(b)),
    KRATER_MEASURE(maximum, false, extreme(m, b, 1)),
    KRATER_MEASURE(minimum, false, extreme(m, b, 0)),
    KRATER_MEASURE(penetration_depth, false, penetration_depth(m, b, c, s)),
    KRATER_MEASURE(crater_depth, false, crater_depth(b, c, m.side, s.face)),
    KRATER_MEASURE(crater_diameter, false, crater_diameter(b, c, m.side, s.face, m.level)),
    KRATER_MEASURE(hole_diameter, false, hole_diameter(b, c)),
    KRATER_MEASURE(debris_extent, false, debris_extent(m, b, c)),
    KRATER_MEASURE(fragments, true, static_cast<double>(connected_pieces(b, c).list.size())),
    KRATER_MEASURE(impulse, true, along(m, c.impulse)),
    KRATER_MEASURE(force, true, along(m, c.impulse)),
    KRATER_MEASURE(angular_momentum, false, angular_momentum(b, c, direction_of(m))),
    KRATER_MEASURE(obliquity, false, obliquity(b, c, direction_of(m))),
    KRATER_MEASURE(yaw, false, yaw(b, c)),
    KRATER_MEASURE(tilt, false, tilt(b, c, direction_of(m))),
    KRATER_MEASURE(sound_mass, true, mass(b) - failed_mass(b)),
    KRATER_MEASURE(bulge, false, bulge(m, b, c, s)),
};
#undef KRATER_MEASURE

constexpr bool in_order() {
  int next = 0;
  for (const Evaluator& e : kEvaluators)
    if (static_cast<int>(e.kind) != next++) return false;
  return next == static_cast<int>(MeasureKind::bulge) + 1;
}
static_assert(in_order());

/// The points p for which keep(p).
template <class K>
BodyPoints filtered(const BodyPoints& points, const K& keep) {
  BodyPoints out;
  for (const auto& [name, values] : points.scalars) out.scalars[name];
  for (std::size_t p = 0; p < points.count(); ++p) {
    if (!keep(p)) continue;
    out.x.push_back(points.x[p]);
    if (!points.v.empty()) out.v.push_back(points.v[p]);
    out.mass.push_back(points.mass[p]);
    out.density.push_back(points.density[p]);
    if (!points.body.empty()) out.body.push_back(points.body[p]);
    if (!points.rubble.empty()) out.rubble.push_back(points.rubble[p]);
    for (auto& [name, values] : out.scalars) values.push_back(points.scalars.at(name)[p]);
  }
  return out;
}

bool inside(const MeasureSelection& selection, const Triple& x, int dimension) {
  for (std::size_t d = 0; d < index(dimension); ++d)
    if (x[d] < selection.region[d][0] || x[d] > selection.region[d][1]) return false;
  return true;
}

}  // namespace

BodyPoints select(const MeasureSelection& selection, const BodyPoints& points,
                  const MeasureContext& context) {
  const bool everywhere = selection.region == MeasureSelection{}.region;
  const BodyPoints placed = everywhere ? points : filtered(points, [&](std::size_t p) {
    return inside(selection, points.x[p], dimension(context.frame));
  });
  if (!selection.largest_piece && selection.least_points <= 1) return placed;
  const Pieces pieces = connected_pieces(placed, context);
  return filtered(placed, [&](std::size_t p) {
    const Piece& piece = pieces.list[index(pieces.of[p])];
    return (!selection.largest_piece || pieces.of[p] == 0) &&
           piece.points >= index(selection.least_points);
  });
}

double face_position(const MeasureOptions& measure, const BodyPoints& points,
                     const MeasureContext& context) {
  if (points.count() == 0) return kNothing;
  return outermost(points, context, measure.axis, measure.side);
}

double evaluate(const MeasureOptions& measure, const BodyPoints& points,
                const MeasureContext& context, const MeasureStart& start) {
  const Evaluator& evaluator = kEvaluators[static_cast<std::size_t>(measure.kind)];
  if (points.empty() && !evaluator.sums) return kNothing;
  return evaluator.evaluate(measure, points, context, start);
}

}  // namespace krater
