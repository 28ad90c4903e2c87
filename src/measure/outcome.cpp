// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/outcome.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace krater {

namespace {

constexpr double kTouched = 1e-3;  // of |w_0|
constexpr double kRest = 2;        // tolerances of |w_0|
constexpr double kRings = 0.15;    // of |w_0|
constexpr double kLasts = 4;       // the time of the change over that of rest

double length(const Triple& v) { return std::hypot(v[0], v[1], v[2]); }
double distance(const Triple& a, const Triple& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Symmetry planes, and the axis, within a cell of the points.
std::array<bool, 3> mirrored_axes(const BodyPoints& points, const MeasureContext& context) {
  const PointBox box = box_of(points);
  std::array<bool, 3> out{};
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(context.frame)); ++a)
    out[a] = (context.boundary[a][0] == BoundaryKind::symmetry &&
              box.low[a] - context.min[a] < context.h) ||
             (context.boundary[a][1] == BoundaryKind::symmetry &&
              context.max[a] - box.high[a] < context.h);
  return out;
}

Triple own_motion(Triple v, const OutcomeStart& start) {
  for (std::size_t a = 0; a < 3; ++a)
    if (start.mirrored[a]) v[a] = 0;
  return v;
}

Triple mean_velocity(const BodyPoints& points) {
  Triple p{};
  double mass = 0;
  for (std::size_t i = 0; i < points.count(); ++i) {
    mass += points.mass[i];
    for (std::size_t a = 0; a < 3; ++a) p[a] += points.mass[i] * points.v[i][a];
  }
  for (double& x : p) x /= mass > 0 ? mass : 1;
  return p;
}

}  // namespace

const char* name_of(Fate fate) {
  constexpr std::array names{"moving", "perforated", "stopped", "ricocheted", "missed"};
  return names[static_cast<std::size_t>(fate)];
}

PointBox box_of(const BodyPoints& points) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  PointBox box{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (const Triple& x : points.x)
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = std::min(box.low[a], x[a]);
      box.high[a] = std::max(box.high[a], x[a]);
    }
  return box;
}

OutcomeStart outcome_start(const BodyPoints& projectile, const BodyPoints& target,
                           const MeasureContext& context) {
  OutcomeStart start;
  for (const double m : projectile.mass) start.mass += m;
  start.mirrored = mirrored_axes(projectile, context);
  Triple w = own_motion(mean_velocity(projectile), start);
  start.has_target = target.count() > 0;
  if (!start.has_target) {
    start.speed = length(w);
    return start;
  }
  const Triple u = own_motion(mean_velocity(target), start);
  for (std::size_t a = 0; a < 3; ++a) w[a] -= u[a];
  const PointBox mine = box_of(projectile), its = box_of(target);
  double latest = -std::numeric_limits<double>::infinity();
  for (int d = 0; d < dimension(context.frame); ++d) {
    const auto a = static_cast<std::size_t>(d);
    if (w[a] == 0) continue;
    const bool up = w[a] > 0;
    const double gap = up ? its.low[a] - mine.high[a] : mine.low[a] - its.high[a];
    const double entry = gap / std::abs(w[a]);
    if (entry <= latest) continue;
    latest = entry;
    start.speed = length(w);
    start.axis = d;
    start.into = up ? 1 : -1;
    start.face = up ? its.low[a] : its.high[a];
    start.thickness = its.high[a] - its.low[a];
  }
  return start;
}

OutcomeState outcome_state(const BodyPoints& projectile, const MeasureContext& context,
                           const OutcomeStart& start) {
  OutcomeState state;
  const Pieces pieces = connected_pieces(projectile, context);
  const auto a = static_cast<std::size_t>(start.axis);
  for (std::size_t i = 0; i < projectile.count(); ++i) {
    const double m = projectile.mass[i], depth = start.into * (projectile.x[i][a] - start.face);
    state.mass += m;
    if (depth > start.thickness) state.through += m;
    if (depth < 0) state.before += m;
  }
  if (!(state.mass > 0)) return state;
  const Piece& main = pieces.list.front();
  state.main = main.mass / state.mass;
  state.through /= state.mass;
  state.before /= state.mass;
  state.velocity = own_motion(state.broken() ? mean_velocity(projectile) : main.velocity, start);
  const PointBox box = state.broken() ? box_of(projectile) : PointBox{main.low, main.high};
  const double low = start.into * (box.low[a] - start.face),
               high = start.into * (box.high[a] - start.face);
  state.rear = std::min(low, high);
  state.front = std::max(low, high);
  return state;
}

Fate fate_of(const OutcomeState& state, const Triple& w, const Settling& settling,
             const OutcomeStart& start, double tolerance) {
  const double into = start.into * w[static_cast<std::size_t>(start.axis)],
               rest = kRest * tolerance * start.speed;
  if (!start.has_target) return Fate::moving;
  if (state.rear > start.thickness && into > rest)
    return settling.touched ? Fate::perforated : Fate::missed;
  if (!settling.touched) return Fate::moving;
  if (settling.stopped) return Fate::stopped;
  if (into < -rest && (state.front < 0 || settling.quiet)) return Fate::ricocheted;
  return Fate::moving;
}

namespace {

/// Of looks from `first` on, which began to change there: at rest, but for ringing. The mean of one
/// stretch is small too while a body that bounces back turns round.
bool at_rest(const std::vector<OutcomeLook>& looks, std::size_t first, const OutcomeStart& start,
             double tolerance) {
  const double now = looks.back().time, third = (now - looks[first].time) / 3;
  std::array<Triple, 2> sum{};
  std::array<std::size_t, 2> count{};
  for (std::size_t i = looks.size(); i-- > first && looks[i].time >= now - third;) {
    if (length(looks[i].w) > kRings * start.speed) return false;
    const std::size_t half = looks[i].time >= now - third / 2 ? 1 : 0;
    count[half] += 1;
    for (std::size_t a = 0; a < 3; ++a) sum[half][a] += looks[i].w[a];
  }
  const double rest = kRest * tolerance * start.speed;
  return std::min(count[0], count[1]) >= 2 && count[0] + count[1] >= 5 &&
         length(sum[0]) < static_cast<double>(count[0]) * rest &&
         length(sum[1]) < static_cast<double>(count[1]) * rest;
}

}  // namespace

Settling settling_of(const std::vector<OutcomeLook>& looks, const OutcomeStart& start,
                     double tolerance) {
  Settling out;
  if (looks.empty()) return out;
  const OutcomeLook& last = looks.back();
  double change = 0, away = 0;
  for (const OutcomeLook& look : looks) {
    change = std::max(change, distance(look.v, last.v));
    away = std::max(away, distance(look.v, looks.front().v));
  }
  out.touched = away > kTouched * start.speed;
  std::size_t quiet = looks.size() - 1, first = 0;
  while (first < quiet && distance(looks[first + 1].v, looks.front().v) <= tolerance * away)
    ++first;
  out.stopped = start.has_target && out.touched && at_rest(looks, first, start, tolerance);
  const auto is_quiet = [&](const OutcomeLook& look) {
    return out.stopped ? length(look.w) <= kRings * start.speed
                       : distance(look.v, last.v) <= tolerance * change;
  };
  while (quiet > 0 && is_quiet(looks[quiet - 1])) --quiet;
  const double since = looks[quiet].time, changed = since - looks[std::min(first, quiet)].time;
  out.quiet = out.stopped ||
              (out.touched && looks.size() - quiet > 3 && kLasts * (last.time - since) >= changed);
  if (!out.quiet) quiet = looks.size() - 1 - looks.size() / 10;
  out.since = looks[quiet].time;
  for (std::size_t i = quiet; i < looks.size(); ++i)
    out.drift = std::max(out.drift, distance(looks[i].v, last.v));
  return out;
}

bool settled(const std::vector<OutcomeLook>& looks, const OutcomeStart& start, double tolerance) {
  if (looks.empty() || !settling_of(looks, start, tolerance).quiet) return false;
  return !start.has_target || looks.back().fate != static_cast<double>(Fate::moving);
}

double fate_since(const std::vector<OutcomeLook>& looks) {
  if (looks.empty()) return 0;
  std::size_t i = looks.size() - 1;
  while (i > 0 && looks[i - 1].fate == looks.back().fate) --i;
  return looks[i].time;
}

}  // namespace krater
