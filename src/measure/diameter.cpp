// SPDX-License-Identifier: GPL-3.0-or-later
// Diameters at a height: a band of points about it (definitions: measure/measures.hpp).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "krater/core/parallel.hpp"
#include "krater/measure/measure_surface.hpp"
#include "measure/mesh_surface.hpp"
#include "measure/surface_points.hpp"

namespace krater {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kBand = 1.5;  // b / a: 1 is noisier with irregular points, 2 sees more curvature

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// How far from its height a band sees points.
double band_reach(const MeasureContext& context) { return 1.5 * kBand * node_spacing(context); }

/// A point of the band about z0: coordinate across the axis, A_p K / b, distance from z0 in a.
struct BandPoint {
  double q, content, u;
};

/// The section at z0: what is measured across, and where it is cut by a symmetry plane.
struct Band {
  std::vector<BandPoint> points;
  MeasuringAxis axis;
  std::array<double, 2> domain{-std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity()};  ///< on its axis [m]
  int trusted =
      0;  ///< nodes about the axis of a 3d body, where 1 / r varies within one point, are not
};

/// The line of phi and its moments in the band; side 1 outwards along q, side 0 against it.
std::optional<double> edge(const Band& band, int side) {
  const MeasuringAxis& axis = band.axis;
  FractionLine line;
  line.spacing = axis.spacing;
  line.closed_inner = axis.closed[index(1 - side)];
  line.closed_outer = axis.closed[index(side)];
  line.trusted = band.trusted;
  for (auto* values : {&line.phi, &line.first, &line.second})
    values->assign(index(axis.count), 0.0);
  for (const BandPoint& point : band.points) {
    const NodeWeights w = node_weights(axis, point.q);
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t i = index(side == 1 ? w.index[n] : axis.count - 1 - w.index[n]);
      const double share = w.weight[n] * point.content / axis.spacing;
      line.phi[i] += share;
      line.first[i] += share * point.u;
      line.second[i] += share * point.u * point.u;
    }
  }
  // How full a full line is depends on how much of the band lies beyond the body's end.
  line.full = 0;
  for (std::size_t i = 1; i + 1 < line.phi.size(); ++i) {
    line.full = std::max(line.full, (line.phi[i - 1] + line.phi[i] + line.phi[i + 1]) / 3);
  }
  const std::optional<LineEdge> found = outer_edge(line);
  if (!found) return std::nullopt;
  const double place =
      side == 1 ? axis.origin + found->place : axis.node(axis.count - 1) - found->place;
  return std::clamp(place, band.domain[0], band.domain[1]);
}

/// Calls work(p) for all points, some thousands at a time.
template <class Work>
void for_points(std::size_t count, const Work& work) {
  constexpr std::size_t kPart = 2048;
  for_each((count + kPart - 1) / kPart, [&](std::size_t i) {
    for (std::size_t p = i * kPart; p < std::min(count, (i + 1) * kPart); ++p) work(p);
  });
}

/// Of every point for the band about z0 on the last axis: K, and what it fills of its volume.
struct BandWeights {
  std::vector<double> K, filled;

  BandWeights(const BodyPoints& body, const MeasureContext& context, double z0)
      : K(body.count()), filled(body.count()) {
    const int last = dimension(context.frame) - 1;
    const double b = kBand * node_spacing(context);
    for_points(body.count(), [&](std::size_t p) {
      K[p] = bspline((body.x[p][index(last)] - z0) / b);
      filled[p] = filled_volume(body, context, p);
    });
  }
};

/// 3d: the axis of the body at the height of the band.
double centre(const BodyPoints& body, const MeasureContext& context, const BandWeights& weights,
              int d) {
  const std::optional<int> side = cut_side(body, context, d);
  if (side) return *side == 0 ? context.min[index(d)] : context.max[index(d)];
  double sum = 0, moment = 0;
  for (std::size_t p = 0; p < body.count(); ++p) {
    const double filled = weights.K[p] * weights.filled[p];
    sum += filled;
    moment += filled * body.x[p][index(d)];
  }
  return moment / sum;
}

/// The band of a round body, as the half section (r, z).
Band round_band(const BodyPoints& body, const MeasureContext& context, double z0) {
  const double a = node_spacing(context), b = kBand * a;
  const int last = dimension(context.frame) - 1;
  const BandWeights weights{body, context, z0};
  const bool space = context.frame == Frame::cartesian_3d;
  Triple middle{};
  double share = 1;
  for (int d = 0; space && d < 2; ++d) {
    middle[index(d)] = centre(body, context, weights, d);
    if (cut_side(body, context, d)) share /= 2;
  }
  Band band;
  band.points.resize(body.count());
  for_points(body.count(), [&](std::size_t p) {
    const Triple& x = body.x[p];
    const double r = space ? std::hypot(x[0] - middle[0], x[1] - middle[1]) : x[0];
    band.points[p] = {r, section(weights.filled[p], r, share, a) * weights.K[p] / b,
                      (x[index(last)] - z0) / a};
  });
  std::size_t seen = 0;
  double furthest = 0;
  for (std::size_t p = 0; p < body.count(); ++p) {
    if (weights.K[p] == 0) continue;
    furthest = std::max(furthest, band.points[p].q);
    band.points[seen++] = band.points[p];
  }
  band.points.resize(seen);
  const double lower = space ? 0.0 : context.min[0];
  const bool inner = space || is_symmetry(context, 0, 0);
  band.trusted = space ? 2 : 0;
  if (!space) band.domain = {context.min[0], context.max[0]};
  const bool outer = !space && is_closed(context, 0, 1);
  const double far = space ? lower + a * (std::ceil(furthest / a) + 3) : context.max[0];
  band.axis =
      measuring_axis(a, {lower, far}, {inner, outer}, {space ? 0.0 : range(body, 0)[0], furthest});
  return band;
}

Band flat_band(const BodyPoints& body, const MeasureContext& context, double z0) {
  const double a = node_spacing(context), b = kBand * a;
  const BandWeights weights{body, context, z0};
  Band band;
  for (std::size_t p = 0; p < body.count(); ++p) {
    if (weights.K[p] == 0) continue;
    band.points.push_back(
        {body.x[p][0], weights.filled[p] * weights.K[p] / b, (body.x[p][1] - z0) / a});
  }
  band.axis = body_axis(body, context, 0);
  band.domain = {context.min[0], context.max[0]};
  return band;
}

/// What a band about z0 sees, with the bounds of the whole body: a symmetry plane cuts that.
BodyPoints points_about(const BodyPoints& body, const MeasureContext& context, double z0) {
  const int dim = dimension(context.frame);
  const double reach = band_reach(context);
  BodyPoints own;
  const BodyPoints& found = layer_of(body, dim - 1, z0 - reach, z0 + reach, own);
  BodyPoints near = &found == &own ? std::move(own) : found;
  near.memo = std::make_shared<SurfaceMemo>();
  near.memo->bounds.emplace();
  for (int d = 0; d < dim; ++d) near.memo->bounds->all[index(d)] = range(body, d);
  return near;
}

/// Diameter at z0, between the lowest and highest place of the body.
double diameter_at(const BodyPoints& body, const MeasureContext& context, double z0) {
  if (!body.edges.empty()) {
    std::array<std::optional<double>, 2> middle;
    for (int d = 0; d + 1 < dimension(context.frame); ++d)
      if (const std::optional<int> side = cut_side(body, context, d))
        middle[index(d)] = *side == 0 ? context.min[index(d)] : context.max[index(d)];
    return mesh_diameter(body, context.frame, middle, z0);
  }
  if (context.frame != Frame::plane_strain) {
    const std::optional<double> r = edge(round_band(body, context, z0), 1);
    return r ? 2 * *r : kNothing;
  }
  const Band band = flat_band(body, context, z0);
  const std::optional<int> cut = cut_side(body, context, 0);
  const std::optional<double> right = edge(band, 1), left = edge(band, 0);
  if (!left || !right) return kNothing;
  if (!cut) return *right - *left;
  return 2 * (*cut == 0 ? *right - context.min[0] : context.max[0] - *left);
}

/// Points sorted into slices of a along the last axis, for bands about many heights.
class Slices {
 public:
  Slices(const BodyPoints& body, const MeasureContext& context)
      : body_{body},
        last_{index(dimension(context.frame) - 1)},
        width_{node_spacing(context)},
        reach_{band_reach(context)},
        low_{range(body, static_cast<int>(last_))[0]} {
    for (std::size_t p = 0; p < body.count(); ++p) {
      const std::size_t slice = slice_of(body.x[p][last_]);
      if (slice >= slices_.size()) slices_.resize(slice + 1);
      slices_[slice].push_back(p);
    }
  }

  BodyPoints about(double z0) const {
    BodyPoints out;
    for (std::size_t s = slice_of(z0 - reach_); s <= slice_of(z0 + reach_); ++s) {
      if (s >= slices_.size()) break;
      for (const std::size_t p : slices_[s]) {
        out.x.push_back(body_.x[p]);
        out.mass.push_back(body_.mass[p]);
        out.density.push_back(body_.density[p]);
      }
    }
    return out;
  }

 private:
  std::size_t slice_of(double z) const {
    return static_cast<std::size_t>(std::max(0.0, std::floor((z - low_) / width_)));
  }

  const BodyPoints& body_;
  std::size_t last_;
  double width_, reach_, low_;
  std::vector<std::vector<std::size_t>> slices_;
};

}  // namespace

double diameter(const BodyPoints& body, const MeasureContext& context, double at, bool from_end) {
  const auto [low, high] = surface_ends(body, context, dimension(context.frame) - 1);
  const double z0 = from_end ? low + at : at;
  const double reach = node_spacing(context) / 2;
  if (!(z0 > low - reach && z0 < high + reach)) return kNothing;
  const double at_body = std::clamp(z0, low, high);
  if (!body.edges.empty()) return diameter_at(body, context, at_body);
  const BodyPoints near = points_about(body, context, at_body);
  return near.count() > 0 ? diameter_at(near, context, at_body) : kNothing;
}

double largest_diameter(const BodyPoints& body, const MeasureContext& context, double within) {
  const std::array<double, 2> ends = surface_ends(body, context, dimension(context.frame) - 1);
  const double low = ends[0], top = ends[1];  // clang 14 captures no bindings
  const double high = within > 0 ? std::min(top, low + within) : top;
  if (!body.edges.empty()) {
    double widest = kNothing;
    for (const double z : mesh_heights(body, dimension(context.frame) - 1, low, high))
      widest = std::fmax(widest, diameter_at(body, context, z));
    return widest;
  }
  const int last = dimension(context.frame) - 1;
  const double reach = band_reach(context);
  const bool part = high < top;
  BodyPoints own;
  const Slices slices{part ? layer_of(body, last, low - reach, high + reach, own) : all_of(body),
                      context};
  const double heights = std::max(1.0, std::ceil((high - low) / node_spacing(context)));
  std::vector<double> found(static_cast<std::size_t>(heights) + 1);
  for_each(found.size(), [&](std::size_t i) {
    const double z0 = low + (high - low) * static_cast<double>(i) / heights;
    const BodyPoints near = slices.about(z0);
    found[i] = near.count() > 0 ? diameter_at(near, context, z0) : kNothing;
  });
  double largest = kNothing;
  for (const double diameter : found) largest = std::fmax(largest, diameter);
  return largest;
}

}  // namespace krater
