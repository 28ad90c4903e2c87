// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/seeds/lattice_filler.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "krater/core/parallel.hpp"

namespace krater {
namespace {

constexpr std::int32_t nothing = -1;

/// Below this share of the lattice cell a part is a sliver; a hair less than half, for exact
/// halves.
constexpr double sliver_fraction = 0.5 * (1 - 1e-9);
/// Candidates within this of the best share with it. At round-off only, single cells at the steps
/// of a sphere or cylinder grew to 2.6 times their nominal mass; with 0.3 to 2.1, a ball's to 1.5.
constexpr double tie = 0.3;
/// How deep a point goes that is moved into the material, in spacings.
constexpr double pull_depth = 0.05;

}  // namespace

Filler::Filler(const Solid& solid, Frame frame, const LatticeOptions& options, const Box& domain)
    : solid_(solid),
      frame_(frame),
      dimensions_(dimension(frame)),
      region_(intersection(in_frame(frame, domain), solid.extent(frame), dimensions_)),
      cells_(region_, frame, options),
      spacing_(lattice_spacing(options)) {}

std::vector<SeedPoint> Filler::run(FillReport& report) {
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
  pull_inside();
  return std::move(points_);
}

void Filler::visit_cells() {
  std::vector<Slab> slabs(static_cast<std::size_t>(cells_.last(0) - cells_.first(0) + 1));
  for_each(slabs.size(), [&](std::size_t n) {
    visit_slab(cells_.first(0) + static_cast<std::int64_t>(n), slabs[n]);
  });
  join(slabs);
}

void Filler::visit_slab(std::int64_t i, Slab& slab) {
  const auto height = static_cast<std::size_t>(cells_.last(2) - cells_.first(2) + 1);
  std::vector<Box> boxes(height);
  std::vector<CellPart> parts(height);
  for (std::int64_t j = cells_.first(1); j <= cells_.last(1); ++j) {
    visit_column({i, j, 0}, slab, boxes, parts);
  }
}

void Filler::visit_column(CellIndex c, Slab& slab, std::vector<Box>& boxes,
                          std::vector<CellPart>& parts) {
  bool any = false;
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    c.k = cells_.first(2) + static_cast<std::int64_t>(n);
    boxes[n] = intersection(cells_.box(c), region_, dimensions_);
    any = any || !is_empty(boxes[n], dimensions_);
  }
  if (!any) return;
  solid_.clip_column(frame_, boxes, parts.data());
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    if (!(parts[n].measure > 0)) continue;
    c.k = cells_.first(2) + static_cast<std::int64_t>(n);
    if (parts[n].section < sliver_fraction * cells_.content()) {
      slab.slivers.push_back({c, parts[n]});
      continue;
    }
    if (parts[n].section < (1 - 1e-9) * cells_.content()) {
      slab.cut.push_back(static_cast<std::uint32_t>(slab.points.size()));
    }
    slots_[cells_.slot(c)] = static_cast<Slot>(slab.points.size());
    slab.points.push_back(seed(parts[n], boxes[n]));
  }
}

/// Slabs are freed one by one as they are copied: the points exist once, not twice.
void Filler::join(std::vector<Slab>& slabs) {
  std::size_t count = 0, slivers = 0;
  for (const Slab& slab : slabs) {
    count += slab.points.size();
    slivers += slab.slivers.size();
  }
  if (count + slivers > static_cast<std::size_t>(std::numeric_limits<Slot>::max())) {
    throw std::invalid_argument("more than 2e9 points in one body");
  }
  points_.reserve(count + slivers);
  cut_.assign(count, false);
  slivers_.reserve(slivers);
  const std::size_t per_slab = slots_.size() / slabs.size();
  for (std::size_t n = 0; n < slabs.size(); ++n) {
    const auto first = static_cast<Slot>(points_.size());
    for (std::size_t s = n * per_slab; s < (n + 1) * per_slab; ++s) {
      if (slots_[s] != nothing) slots_[s] += first;
    }
    for (const std::uint32_t p : slabs[n].cut) cut_[static_cast<std::size_t>(first) + p] = true;
    points_.insert(points_.end(), slabs[n].points.begin(), slabs[n].points.end());
    slivers_.insert(slivers_.end(), slabs[n].slivers.begin(), slabs[n].slivers.end());
    slabs[n] = {};
  }
}

SeedPoint Filler::seed(const CellPart& part, const Box& clipped) const {
  SeedPoint point;
  point.measure = part.measure;
  point.x = part.centroid;
  if (frame_ == Frame::axisymmetric) {
    point.x[0] = part.measure / (2 * std::numbers::pi * part.section);
  }
  for (int a = 0; a < dimensions_; ++a) {
    point.half_width[static_cast<std::size_t>(a)] = 0.5 * clipped.length(a);
  }
  return point;
}

/// Area in 2D, volume in 3D: how full a cell is, whatever its r.
double Filler::content(const SeedPoint& point) const {
  if (frame_ != Frame::axisymmetric) return point.measure;
  return point.measure / (2 * std::numbers::pi * point.x[0]);
}

void Filler::consider(Best& best, const CellIndex& c, double overlap, int axis) const {
  if (!cells_.has(c)) return;
  const Slot slot = slots_[cells_.slot(c)];
  if (slot == nothing) return;
  best.scores[best.count] = overlap * content(points_[static_cast<std::size_t>(slot)]);
  best.score = std::max(best.score, best.scores[best.count]);
  best.to[best.count] = slot;
  best.axis[best.count++] = axis;
}

Filler::Best Filler::face_gifts(const CellIndex& c) const {
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

Filler::Best Filler::corner_gifts(const CellIndex& c) const {
  Best best;
  cells_.for_neighbours(c, [&](const CellIndex& n) { consider(best, n, 1, -1); });
  return best;
}

/// Decide all gifts before any is made, so that their order does not matter.
void Filler::give(std::vector<std::size_t>& pending,
                  Best (Filler::*choose)(const CellIndex&) const) {
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

void Filler::absorb(const Gift& gift) {
  cut_[static_cast<std::size_t>(gift.to)] = true;
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
void Filler::keep_fullest(std::vector<std::size_t>& pending, FillReport& report) {
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
    slots_[cells_.slot(slivers_[n].at)] = static_cast<Slot>(points_.size());
    points_.push_back(seed(slivers_[n].part, clipped));
    cut_.push_back(true);
    ++report.slivers_kept;
  }
  pending.swap(left);
}

/// The centroid of a cell's part, or of a point with slivers merged, may lie beside the material.
void Filler::pull_inside() {
  constexpr std::size_t batch = 4096;
  for_each((points_.size() + batch - 1) / batch, [&](std::size_t b) {
    for (std::size_t n = b * batch; n < std::min(points_.size(), (b + 1) * batch); ++n) {
      if (cut_[n] && !solid_.contains(frame_, points_[n].x)) pull_inside(points_[n]);
    }
  });
}

void Filler::pull_inside(SeedPoint& point) const {
  const Vector3 x = to_space(frame_, point.x);
  Spans found;
  std::array<double, 3> best = point.x;
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < dimensions_; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    solid_.spans(along_axis(x, tensor_axis(frame_, axis)), found);
    for (const Span& s : found) {
      const double low = std::max(s.low, region_.min[a]), high = std::min(s.high, region_.max[a]);
      if (!(high > low)) continue;
      const double depth = std::min(pull_depth * spacing_[a], 0.5 * (high - low));
      const double to = std::clamp(point.x[a], low + depth, high - depth);
      if (std::abs(to - point.x[a]) >= least) continue;
      least = std::abs(to - point.x[a]);
      best = point.x;
      best[a] = to;
    }
  }
  if (least < 2 * *std::max_element(spacing_.begin(), spacing_.end())) point.x = best;
}

}  // namespace krater
