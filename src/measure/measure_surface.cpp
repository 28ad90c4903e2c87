// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/measure_surface.hpp"

#include "measure/mesh_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

namespace krater {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kBand = 1.5;  // b / a: 1 is noisier with irregular points, 2 sees more curvature
constexpr double kTouching = 1.0;  // a body this near to a symmetry plane, in a, is cut by it

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Least and greatest coordinate of the points.
std::array<double, 2> range(const BodyPoints& body, int axis) {
  std::array<double, 2> result{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
  for (const Triple& x : body.x) {
    result = {std::min(result[0], x[index(axis)]), std::max(result[1], x[index(axis)])};
  }
  return result;
}

/// A_p at distance r from the axis for a share of the full revolution. A point on the axis itself
/// stands for radii up to its own size, so r is bounded below.
double section(double volume, double r, double share, double a) {
  return volume / (2 * std::numbers::pi * share * std::max(r, 0.2 * a));
}

double volume(const BodyPoints& body, std::size_t p) { return body.mass[p] / body.density[p]; }

/// filled_volume() of many points.
class Filling {
 public:
  explicit Filling(const MeasureContext& context)
      : revolved_{context.frame == Frame::axisymmetric},
        a_{node_spacing(context)},
        cell_{a_ * a_ * (context.frame == Frame::cartesian_3d ? a_ : 1)} {}
  double operator()(const BodyPoints& body, std::size_t p) const {
    const double round = revolved_ ? 2 * std::numbers::pi * std::max(body.x[p][0], 0.2 * a_) : 1.0;
    return std::min(volume(body, p), cell_ * round);
  }

 private:
  bool revolved_;
  double a_, cell_;
};

/// Over the points, and up to symmetry planes where `to_planes`.
MeasuringAxis body_axis(const BodyPoints& body, const MeasureContext& context, int d,
                        bool to_planes = false) {
  std::array<double, 2> occupied = range(body, d);
  if (to_planes && is_symmetry(context, d, 0)) occupied[0] = context.min[index(d)];
  if (to_planes && is_symmetry(context, d, 1)) occupied[1] = context.max[index(d)];
  return measuring_axis(node_spacing(context), {context.min[index(d)], context.max[index(d)]},
                        {is_closed(context, d, 0), is_closed(context, d, 1)}, occupied);
}

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

/// K of every point for the band about z0 on the last axis.
std::vector<double> band_weights(const BodyPoints& body, int last, double z0, double b) {
  std::vector<double> weights(body.count());
  for (std::size_t p = 0; p < body.count(); ++p)
    weights[p] = bspline((body.x[p][index(last)] - z0) / b);
  return weights;
}

/// 3d: the axis of the body at the height of the band.
double centre(const BodyPoints& body, const MeasureContext& context,
              const std::vector<double>& weights, int d) {
  const std::optional<int> side = cut_side(body, context, d);
  if (side) return *side == 0 ? context.min[index(d)] : context.max[index(d)];
  double sum = 0, moment = 0;
  for (std::size_t p = 0; p < body.count(); ++p) {
    const double filled = weights[p] * filled_volume(body, context, p);
    sum += filled;
    moment += filled * body.x[p][index(d)];
  }
  return moment / sum;
}

/// The band of a round body, as the half section (r, z).
Band round_band(const BodyPoints& body, const MeasureContext& context, double z0) {
  const double a = node_spacing(context), b = kBand * a;
  const int last = dimension(context.frame) - 1;
  const std::vector<double> weights = band_weights(body, last, z0, b);
  const bool space = context.frame == Frame::cartesian_3d;
  Triple middle{};
  double share = 1;
  for (int d = 0; space && d < 2; ++d) {
    middle[index(d)] = centre(body, context, weights, d);
    if (cut_side(body, context, d)) share /= 2;
  }
  Band band;
  double furthest = 0;
  for (std::size_t p = 0; p < body.count(); ++p) {
    if (weights[p] == 0) continue;
    const Triple& x = body.x[p];
    const double r = space ? std::hypot(x[0] - middle[0], x[1] - middle[1]) : x[0];
    band.points.push_back({r,
                           section(filled_volume(body, context, p), r, share, a) * weights[p] / b,
                           (x[index(last)] - z0) / a});
    furthest = std::max(furthest, r);
  }
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
  const std::vector<double> weights = band_weights(body, 1, z0, b);
  Band band;
  for (std::size_t p = 0; p < body.count(); ++p) {
    if (weights[p] == 0) continue;
    band.points.push_back(
        {body.x[p][0], filled_volume(body, context, p) * weights[p] / b, (body.x[p][1] - z0) / a});
  }
  band.axis = body_axis(body, context, 0);
  band.domain = {context.min[0], context.max[0]};
  return band;
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

/// The points that a band about some height may see, sorted into slices of a along the last axis.
class Slices {
 public:
  Slices(const BodyPoints& body, const MeasureContext& context)
      : body_{body},
        last_{index(dimension(context.frame) - 1)},
        width_{node_spacing(context)},
        low_{range(body, static_cast<int>(last_))[0]} {
    for (std::size_t p = 0; p < body.count(); ++p) {
      const std::size_t slice = slice_of(body.x[p][last_]);
      if (slice >= slices_.size()) slices_.resize(slice + 1);
      slices_[slice].push_back(p);
    }
  }

  BodyPoints about(double z0) const {
    const double reach = 1.5 * kBand * width_;
    BodyPoints out;
    for (std::size_t s = slice_of(z0 - reach); s <= slice_of(z0 + reach); ++s) {
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
  double width_, low_;
  std::vector<std::vector<std::size_t>> slices_;
};

}  // namespace

double node_spacing(const MeasureContext& context) {
  return 2 * context.h / context.points_per_direction;
}

double filled_volume(const BodyPoints& body, const MeasureContext& context, std::size_t p) {
  return Filling{context}(body, p);
}

bool is_closed(const MeasureContext& context, int axis, int side) {
  return context.boundary[index(axis)][index(side)] != BoundaryKind::open;
}

bool is_symmetry(const MeasureContext& context, int axis, int side) {
  return context.boundary[index(axis)][index(side)] == BoundaryKind::symmetry;
}

std::optional<int> cut_side(const BodyPoints& body, const MeasureContext& context, int axis) {
  const std::array<double, 2> occupied = range(body, axis);
  const double near = kTouching * node_spacing(context);
  if (is_symmetry(context, axis, 0) && occupied[0] - context.min[index(axis)] < near) return 0;
  if (is_symmetry(context, axis, 1) && context.max[index(axis)] - occupied[1] < near) return 1;
  return std::nullopt;
}

VolumeFraction volume_fraction(const BodyPoints& body, const MeasureContext& context,
                               bool to_planes) {
  std::array<MeasuringAxis, 3> axes;
  for (int d = 0; d < dimension(context.frame); ++d)
    axes[index(d)] = body_axis(body, context, d, to_planes);
  const Filling filling{context};
  const double a = node_spacing(context);
  std::vector<double> sections(body.count());
  for (std::size_t p = 0; p < body.count(); ++p) {
    const double V = filling(body, p);
    sections[p] = context.frame == Frame::axisymmetric ? section(V, body.x[p][0], 1, a) : V;
  }
  return {dimension(context.frame), axes, body.x, sections};
}

VolumeFraction::Walls walls_of(const MeasureContext& context) {
  VolumeFraction::Walls walls{};
  for (int d = 0; d < dimension(context.frame); ++d) {
    for (int s = 0; s < 2; ++s) {
      walls[index(d)][index(s)] = is_closed(context, d, s) && !is_symmetry(context, d, s);
    }
  }
  return walls;
}

namespace {

/// Places of the points along an axis; of those that stand for more than a cell of the measuring
/// grid each, which fill the cell they lie in, however far their neighbours are.
struct Reach {
  std::array<double, 2> all,
      sparse{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

Reach reach(const BodyPoints& body, const MeasureContext& context, int axis) {
  Reach found{.all = range(body, axis)};
  const Filling filling{context};
  for (std::size_t p = 0; p < body.count(); ++p) {
    if (filling(body, p) == volume(body, p)) continue;
    const double x = body.x[p][index(axis)];
    found.sparse = {std::min(found.sparse[0], x), std::max(found.sparse[1], x)};
  }
  return found;
}

/// Lowest and highest place of the surface along an axis: as far as sparse points, in the domain,
/// within a of the points. Not a number stays so.
std::array<double, 2> ends(const BodyPoints& body, const MeasureContext& context, int axis) {
  std::optional<std::array<double, 2>> found;
  auto& kept = body.memo ? body.memo->ends[index(axis)] : found;
  if (kept) return *kept;
  if (!body.edges.empty()) {
    kept = mesh_ends(body, axis);
    return *kept;
  }
  const VolumeFraction fraction = volume_fraction(body, context);
  const VolumeFraction::Walls walls = walls_of(context);
  const Reach points = reach(body, context, axis);
  const double a = node_spacing(context);
  std::array<double, 2> at{fraction.outermost(axis, 0, walls), fraction.outermost(axis, 1, walls)};
  if (std::isfinite(points.sparse[0]))
    at = {std::fmin(at[0], points.sparse[0]), std::fmax(at[1], points.sparse[1])};
  kept = {std::max({at[0], points.all[0] - a, context.min[index(axis)]}),
          std::min({at[1], points.all[1] + a, context.max[index(axis)]})};
  return *kept;
}

}  // namespace

double outermost(const BodyPoints& body, const MeasureContext& context, int axis, int side) {
  return ends(body, context, axis)[index(side)];
}

double extent(const BodyPoints& body, const MeasureContext& context, int axis) {
  const auto [low, high] = ends(body, context, axis);
  return high - low;
}

double diameter(const BodyPoints& body, const MeasureContext& context, double at, bool from_end) {
  const auto [low, high] = ends(body, context, dimension(context.frame) - 1);
  const double z0 = from_end ? low + at : at;
  const double reach = node_spacing(context) / 2;
  if (!(z0 > low - reach && z0 < high + reach)) return kNothing;
  return diameter_at(body, context, std::clamp(z0, low, high));
}

double largest_diameter(const BodyPoints& body, const MeasureContext& context, double within) {
  const auto [low, top] = ends(body, context, dimension(context.frame) - 1);
  const double high = within > 0 ? std::min(top, low + within) : top;
  if (!body.edges.empty()) {
    double widest = kNothing;
    for (const double z : mesh_heights(body, dimension(context.frame) - 1, low, high))
      widest = std::fmax(widest, diameter_at(body, context, z));
    return widest;
  }
  const Slices slices{body, context};
  const double heights = std::max(1.0, std::ceil((high - low) / node_spacing(context)));
  double largest = kNothing;
  for (double i = 0; i <= heights; ++i) {
    const double z0 = low + (high - low) * i / heights;
    const BodyPoints near = slices.about(z0);
    const double found = near.count() > 0 ? diameter_at(near, context, z0) : kNothing;
    if (std::isnan(largest) || found > largest) largest = found;
  }
  return largest;
}

}  // namespace krater
