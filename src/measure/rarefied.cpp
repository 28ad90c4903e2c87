// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "krater/measure/measure_surface.hpp"

namespace krater {

namespace {

constexpr double kLayer = 2;  // in a

/// Share of their volume that the points for which in_layer(x) fill by the rule of the surface.
template <class L>
double filled_share(const BodyPoints& body, const MeasureContext& context, const L& in_layer) {
  double filled = 0, all = 0;
  for (std::size_t p = 0; p < body.count(); ++p) {
    if (!in_layer(body.x[p])) continue;
    filled += filled_volume(body, context, p);
    all += body.mass[p] / body.density[p];
  }
  return all > 0 ? filled / all : 1;
}

bool thin_end(const BodyPoints& body, const MeasureContext& context, int axis, int side) {
  const double place = outermost(body, context, axis, side);
  const double depth = kLayer * node_spacing(context);
  const auto d = static_cast<std::size_t>(axis);
  return filled_share(body, context, [&](const Triple& x) {
           return side == 1 ? x[d] > place - depth : x[d] < place + depth;
         }) < kRarefied;
}

/// Points of the measured heights that are the furthest from the middle.
bool thin_rim(const MeasureOptions& measure, const BodyPoints& body,
              const MeasureContext& context) {
  const int last = dimension(context.frame) - 1;
  const auto d = static_cast<std::size_t>(last);
  const double a = node_spacing(context), low = outermost(body, context, last, 0);
  const double from = measure.at_from_end ? low + measure.at : measure.at;
  const bool one = measure.kind == MeasureKind::diameter, all = !one && measure.level == 0;
  const auto measured = [&](const Triple& x) {
    return all || (one ? std::abs(x[d] - from) : x[d] - low - measure.level) < kLayer * a;
  };
  Triple middle{};
  for (int axis = 0; axis < last && context.frame != Frame::axisymmetric; ++axis) {
    const auto side = static_cast<std::size_t>(axis);
    middle[side] = (outermost(body, context, axis, 0) + outermost(body, context, axis, 1)) / 2;
    if (is_symmetry(context, axis, 0)) middle[side] = context.min[side];
    if (is_symmetry(context, axis, 1)) middle[side] = context.max[side];
  }
  const auto distance = [&](const Triple& x) {
    return last == 2 ? std::hypot(x[0] - middle[0], x[1] - middle[1]) : std::abs(x[0] - middle[0]);
  };
  double furthest = 0;
  for (const Triple& x : body.x)
    if (measured(x)) furthest = std::max(furthest, distance(x));
  return filled_share(body, context, [&](const Triple& x) {
           return measured(x) && distance(x) > furthest - kLayer * a;
         }) < kRarefied;
}

}  // namespace

bool rarefied(const MeasureOptions& measure, const BodyPoints& body,
              const MeasureContext& context) {
  if (body.count() == 0) return false;
  switch (measure.kind) {
    case MeasureKind::extent:
      return thin_end(body, context, measure.axis, 0) || thin_end(body, context, measure.axis, 1);
    case MeasureKind::max:
    case MeasureKind::min:
      return thin_end(body, context, measure.axis, measure.kind == MeasureKind::max ? 1 : 0);
    case MeasureKind::penetration_depth:
      return thin_end(body, context, measure.axis, 1 - measure.side);
    case MeasureKind::diameter:
    case MeasureKind::largest_diameter:
      return thin_rim(measure, body, context);
    case MeasureKind::hole_diameter:
      if (context.frame == Frame::axisymmetric) return thin_end(body, context, 0, 0);
      [[fallthrough]];
    case MeasureKind::crater_depth:
    case MeasureKind::crater_diameter:
      return filled_share(body, context, [](const Triple&) { return true; }) < kRarefied;
    default:
      return false;
  }
}

}  // namespace krater
