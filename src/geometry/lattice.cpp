// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "lattice_cells.hpp"

namespace krater {
namespace {

using Slot = std::int64_t;
constexpr Slot nothing = -1;

/// Below this share of the lattice cell a part is a sliver; a hair less than half, for exact
/// halves.
constexpr double sliver_fraction = 0.5 * (1 - 1e-9);
/// Candidates within this of the best share with it. At round-off only, single cells at the steps
/// of a sphere or cylinder grew to 2.6 times their nominal mass; with 0.3 to 2.1, a ball's to 1.5.
constexpr double tie = 0.3;

struct Sliver {
  CellIndex at;
  CellPart part;
};

struct Gift {
  std::size_t sliver;
  Slot to;
  double share;
  int axis;  ///< along which giver and taker touch; -1 at an edge or corner
};

class Filler {
 public:
  Filler(const Solid& solid, Frame frame, const LatticeOptions& options, const Box& domain)
      : solid_(solid),
        frame_(frame),
        dimensions_(dimension(frame)),
        region_(intersection(in_frame(frame, domain), solid.extent(frame), dimensions_)),
        cells_(region_, frame, options) {}

  std::vector<SeedPoint> run(FillReport& report) {
    if (is_empty(region_, dimensions_)) return {};
    slots_.assign(cells_.count(), nothing);
    visit_cells();
    std::vector<std::size_t> pending(slivers_.size());
    for (std::size_t n = 0; n < pending.size(); ++n) pending[n] = n;
    while (!pending.empty()) {
      give(pending, &Filler::face_gifts);
      give(pending, &Filler::corner_gifts);
      keep_fullest(pending, report);
    }
    report.slivers_merged = slivers_.size() - report.slivers_kept;
    return std::move(points_);
  }

  const Box& region() const { return region_; }

 private:
  void visit_cells() {
    CellIndex c;
    for (c.i = cells_.first(0); c.i <= cells_.last(0); ++c.i) {
      for (c.j = cells_.first(1); c.j <= cells_.last(1); ++c.j) {
        for (c.k = cells_.first(2); c.k <= cells_.last(2); ++c.k) visit(c);
      }
    }
  }

  void visit(const CellIndex& c) {
    const Box cell = cells_.box(c);
    const Box clipped = intersection(cell, region_, dimensions_);
    if (is_empty(clipped, dimensions_)) return;
    const Place place = solid_.classify(frame_, clipped);
    if (place == Place::outside) return;
    const CellPart part =
        place == Place::inside ? whole_box(frame_, clipped) : solid_.clip(frame_, clipped);
    if (!(part.measure > 0)) return;
    if (part.section < sliver_fraction * cells_.content()) {
      slivers_.push_back({c, part});
    } else {
      keep(c, part, clipped);
    }
  }

  void keep(const CellIndex& c, const CellPart& part, const Box& clipped) {
    SeedPoint point;
    point.measure = part.measure;
    point.x = part.centroid;
    if (frame_ == Frame::axisymmetric) {
      point.x[0] = part.measure / (2 * std::numbers::pi * part.section);
    }
    for (int a = 0; a < dimensions_; ++a) {
      point.half_width[static_cast<std::size_t>(a)] = 0.5 * clipped.length(a);
    }
    slots_[cells_.slot(c)] = static_cast<Slot>(points_.size());
    points_.push_back(point);
  }

  /// Area in 2D, volume in 3D: how full a cell is, whatever its r.
  double content(const SeedPoint& point) const {
    if (frame_ != Frame::axisymmetric) return point.measure;
    return point.measure / (2 * std::numbers::pi * point.x[0]);
  }

  /// Kept cells about a sliver, the best score among them, and where each touches it.
  struct Best {
    double score = 0;
    std::size_t count = 0;
    std::array<double, 26> scores{};
    std::array<Slot, 26> to{};
    std::array<int, 26> axis{};
  };

  void consider(Best& best, const CellIndex& c, double overlap, int axis) const {
    if (!cells_.has(c)) return;
    const Slot slot = slots_[cells_.slot(c)];
    if (slot == nothing) return;
    best.scores[best.count] = overlap * content(points_[static_cast<std::size_t>(slot)]);
    best.score = std::max(best.score, best.scores[best.count]);
    best.to[best.count] = slot;
    best.axis[best.count++] = axis;
  }

  Best face_gifts(const CellIndex& c) const {
    Best best;
    const int last = dimensions_ - 1;
    consider(best, {c.i, c.j, c.k - 1}, 1, last);
    consider(best, {c.i, c.j, c.k + 1}, 1, last);
    for (int axis = 0; axis < last; ++axis) {
      for (const int step : {-1, 1}) {
        CellIndex beside{c.i + (axis == 0 ? step : 0), c.j + (axis == 1 ? step : 0), c.k};
        // Cells of a column with another shift overlap by half; the lower of the two begins half a
        // spacing below.
        const bool aligned = cells_.shifted(beside) == cells_.shifted(c);
        if (!aligned && !cells_.shifted(c)) beside.k -= 1;
        consider(best, beside, aligned ? 1 : 0.5, axis);
        beside.k += 1;
        if (!aligned) consider(best, beside, 0.5, axis);
      }
    }
    return best;
  }

  Best corner_gifts(const CellIndex& c) const {
    Best best;
    cells_.for_neighbours(c, [&](const CellIndex& n) { consider(best, n, 1, -1); });
    return best;
  }

  /// Decide all gifts before any is made, so that their order does not matter.
  void give(std::vector<std::size_t>& pending, Best (Filler::*choose)(const CellIndex&) const) {
    std::vector<Gift> gifts;
    std::vector<std::size_t> left;
    for (const std::size_t n : pending) {
      const Best best = (this->*choose)(slivers_[n].at);
      if (best.count == 0) left.push_back(n);
      const auto takes = [&](std::size_t b) { return best.scores[b] >= best.score * (1 - tie); };
      double takers = 0;
      for (std::size_t b = 0; b < best.count; ++b) takers += takes(b) ? 1 : 0;
      for (std::size_t b = 0; b < best.count; ++b) {
        if (takes(b)) gifts.push_back({n, best.to[b], 1 / takers, best.axis[b]});
      }
    }
    for (const Gift& gift : gifts) absorb(gift);
    pending.swap(left);
  }

  void absorb(const Gift& gift) {
    SeedPoint& point = points_[static_cast<std::size_t>(gift.to)];
    const CellPart& part = slivers_[gift.sliver].part;
    const double section = content(point);
    const double measure = gift.share * part.measure;
    const double total = point.measure + measure;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimensions_); ++a) {
      point.x[a] += measure / total * (part.centroid[a] - point.x[a]);
    }
    const double added = gift.share * part.section;
    if (frame_ == Frame::axisymmetric) {
      point.x[0] = total / (2 * std::numbers::pi * (section + added));
    }
    point.measure = total;
    if (gift.axis >= 0) {
      point.half_width[static_cast<std::size_t>(gift.axis)] *= 1 + added / section;
    }
  }

  /// Slivers with no kept cell anywhere around: those at least half as full as any around them
  /// become points.
  void keep_fullest(std::vector<std::size_t>& pending, FillReport& report) {
    if (pending.empty()) return;
    std::vector<double> section(cells_.count(), 0.0);
    for (const std::size_t n : pending) {
      section[cells_.slot(slivers_[n].at)] = slivers_[n].part.section;
    }
    std::vector<std::size_t> left;
    for (const std::size_t n : pending) {
      double fullest = 0;
      cells_.for_neighbours(slivers_[n].at, [&](const CellIndex& c) {
        if (cells_.has(c)) fullest = std::max(fullest, section[cells_.slot(c)]);
      });
      if (slivers_[n].part.section < 0.5 * fullest) {
        left.push_back(n);
        continue;
      }
      const Box clipped = intersection(cells_.box(slivers_[n].at), region_, dimensions_);
      keep(slivers_[n].at, slivers_[n].part, clipped);
      ++report.slivers_kept;
    }
    pending.swap(left);
  }

  const Solid& solid_;
  Frame frame_;
  int dimensions_;
  Box region_;  ///< the domain's part of the solid's bounding box
  LatticeCells cells_;
  std::vector<Slot> slots_;  ///< of every cell of the region: its point, or nothing
  std::vector<SeedPoint> points_;
  std::vector<Sliver> slivers_;
};

/// splitmix64 (Steele, Lea, Flood 2014): a number of [-1, 1) from a counter, the same on every
/// machine.
double symmetric_random(std::uint64_t counter) {
  std::uint64_t z = counter + 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  z ^= z >> 31;
  return std::ldexp(static_cast<double>(z >> 11), -52) - 1;
}

/// Points that would leave the body or the domain stay where they are.
void shake(std::vector<SeedPoint>& points, const Solid& solid, Frame frame,
           const LatticeOptions& options, const Box& domain) {
  const double amplitude = options.jitter * options.cell / options.points_per_direction;
  const auto dimensions = static_cast<std::size_t>(dimension(frame));
  for (std::size_t n = 0; n < points.size(); ++n) {
    std::array<double, 3> x = points[n].x;
    for (std::size_t a = 0; a < dimensions; ++a) {
      x[a] += amplitude * symmetric_random(options.seed * 0x2545f4914f6cdd1dULL + 3 * n + a);
    }
    const bool on_axis_side = frame != Frame::axisymmetric || x[0] > 0;
    if (on_axis_side && encloses(domain, x, dimension(frame)) && solid.contains(frame, x)) {
      points[n].x = x;
    }
  }
}

/// Neumaier's compensated sum: the report's figure is free of its own round-off.
double total_measure(const std::vector<SeedPoint>& points) {
  double sum = 0, lost = 0;
  for (const SeedPoint& point : points) {
    const double next = sum + point.measure;
    lost += std::abs(sum) >= point.measure ? (sum - next) + point.measure
                                           : (point.measure - next) + sum;
    sum = next;
  }
  return sum + lost;
}

}  // namespace

std::vector<SeedPoint> fill(const Solid& solid, Frame frame, const LatticeOptions& options,
                            const Box& domain, FillReport* report) {
  solid.require(frame);
  if (!(options.cell > 0) || !std::isfinite(options.cell)) {
    throw std::invalid_argument("the grid's cell must be positive and finite");
  }
  if (options.points_per_direction < 1) {
    throw std::invalid_argument("points_per_direction must be at least 1");
  }
  if (!(options.jitter >= 0)) throw std::invalid_argument("jitter must not be negative");
  FillReport local;
  FillReport& out = report ? *report : local;
  out = {};
  Filler filler(solid, frame, options, domain);
  std::vector<SeedPoint> points = filler.run(out);
  if (options.jitter > 0) shake(points, solid, frame, options, filler.region());
  out.count = points.size();
  if (report) {
    out.measure_exact = solid.measure(frame, domain);
    out.measure_points = total_measure(points);
    out.smallest_thickness_in_cells = solid.smallest_thickness(frame, domain) / options.cell;
  }
  return points;
}

}  // namespace krater
