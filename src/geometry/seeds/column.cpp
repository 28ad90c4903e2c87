// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/seeds/column.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace krater {
namespace {

constexpr double tolerance_2d = 1e-8, tolerance_3d = 5e-5;
constexpr int greatest_depth_2d = 30, greatest_depth_3d = 14;
/// Where both directions close in on the same corner the lines would multiply: per column at most.
constexpr std::size_t most_lines = 40'000;
/// The outermost lines lie this share inside the column: a wall on its side is in or out, not both.
constexpr double inset = 1e-9;

/// What two levels are compared by: length in the solid, and its first moment about the column's
/// middle over the reference height.
struct Value {
  double length = 0, moment = 0;
  Value operator+(const Value& o) const { return {length + o.length, moment + o.moment}; }
  Value operator*(double w) const { return {w * length, w * moment}; }
};

double distance(const Value& a, const Value& b) {
  return std::max(std::abs(a.length - b.length), std::abs(a.moment - b.moment));
}

/// The lines of one x: a range of the sampler's list, weighted for y alone; their mean over y.
struct Row {
  Value value;
  std::size_t first = 0, last = 0;
};

class Sampler {
 public:
  Sampler(const Solid& solid, Frame frame, const Box& column, double reference, ColumnLines& out)
      : solid_(solid), full_(frame == Frame::cartesian_3d), box_(column), out_(out) {
    const auto last = static_cast<std::size_t>(dimension(frame) - 1);
    low_ = column.min[last];
    high_ = column.max[last];
    middle_ = 0.5 * (low_ + high_);
    reference_ = reference;
    tolerance_ = full_ ? tolerance_3d : tolerance_2d;
    greatest_depth_ = full_ ? greatest_depth_3d : greatest_depth_2d;
  }

  void run() {
    const auto [a, b] = inner_range(0);
    const std::array<Row, 3> ends{row(a), row(0.5 * (a + b)), row(b)};
    refine_x(a, b, ends, 0);
  }

 private:
  std::pair<double, double> inner_range(int axis) const {
    const auto k = static_cast<std::size_t>(axis);
    const double d = inset * box_.length(axis);
    return {box_.min[k] + d, box_.max[k] - d};
  }

  double allowed() const { return tolerance_ * std::max(reference_, longest_); }
  bool exhausted() const { return lines_.size() > most_lines; }

  std::size_t line(double x, double y, Value& value) {
    solid_.spans(along_axis({x, y, 0}, 2), found_);
    ColumnLines::Sample sample{x, y, 0, static_cast<std::uint32_t>(spans_.size()), 0};
    value = {};
    for (const Span& s : found_) {
      const Span cut{std::max(s.low, low_), std::min(s.high, high_)};
      if (!(cut.high > cut.low)) continue;
      spans_.push_back(cut);
      ++sample.count;
      value.length += cut.length();
      value.moment += cut.length() * (0.5 * (cut.low + cut.high) - middle_);
    }
    value.moment /= high_ - low_;
    longest_ = std::max(longest_, value.length);
    lines_.push_back(sample);
    return lines_.size() - 1;
  }

  struct Node {
    std::size_t at = 0;
    Value value;
  };

  Node node(double x, double y) {
    Node n;
    n.at = line(x, y, n.value);
    return n;
  }

  /// Simpson's rule for the mean over an interval.
  static Value simpson(const Value& a, const Value& middle, const Value& b) {
    return (a + middle * 4 + b) * (1.0 / 6);
  }

  /// Do both levels of Simpson's rule agree, for their share of the column? `fine`: the better
  /// mean.
  bool settled(const std::array<Value, 5>& v, int depth, Value& fine) const {
    const Value coarse = simpson(v[0], v[2], v[4]);
    fine = (simpson(v[0], v[1], v[2]) + simpson(v[2], v[3], v[4])) * 0.5;
    return std::ldexp(distance(coarse, fine), -depth) <= allowed() || depth == greatest_depth_ ||
           exhausted();
  }

  Row row(double x) {
    Row r;
    r.first = accepted_.size();
    if (!full_) {
      accepted_.push_back({line(x, 0, r.value), 1});
    } else {
      const auto [a, b] = inner_range(1);
      r.value = refine_y(x, a, b, {node(x, a), node(x, 0.5 * (a + b)), node(x, b)}, 0);
    }
    r.last = accepted_.size();
    return r;
  }

  /// The share of [a, b] in the mean over y; keeps the lines with their weights.
  Value refine_y(double x, double a, double b, const std::array<Node, 3>& ends, int depth) {
    const double m = 0.5 * (a + b);
    const Node low = node(x, 0.5 * (a + m)), high = node(x, 0.5 * (m + b));
    const double share = std::ldexp(1.0, -depth);
    Value fine;
    if (settled({ends[0].value, low.value, ends[1].value, high.value, ends[2].value}, depth,
                fine)) {
      const double w = box_.length(1) * share / 12;
      accepted_.insert(accepted_.end(), {{ends[0].at, w},
                                         {low.at, 4 * w},
                                         {ends[1].at, 2 * w},
                                         {high.at, 4 * w},
                                         {ends[2].at, w}});
      return fine * share;
    }
    const Value below = refine_y(x, a, m, {ends[0], low, ends[1]}, depth + 1);
    return below + refine_y(x, m, b, {ends[1], high, ends[2]}, depth + 1);
  }

  void refine_x(double a, double b, const std::array<Row, 3>& ends, int depth) {
    const double m = 0.5 * (a + b);
    const Row low = row(0.5 * (a + m)), high = row(0.5 * (m + b));
    const double share = std::ldexp(1.0, -depth);
    Value fine;
    if (settled({ends[0].value, low.value, ends[1].value, high.value, ends[2].value}, depth,
                fine)) {
      const double w = box_.length(0) * share / 12;
      keep(ends[0], w);
      keep(low, 4 * w);
      keep(ends[1], 2 * w);
      keep(high, 4 * w);
      keep(ends[2], w);
      return;
    }
    refine_x(a, m, {ends[0], low, ends[1]}, depth + 1);
    refine_x(m, b, {ends[1], high, ends[2]}, depth + 1);
  }

  void keep(const Row& r, double weight) {
    for (std::size_t n = r.first; n < r.last; ++n) {
      ColumnLines::Sample sample = lines_[accepted_[n].line];
      if (sample.count == 0) continue;
      const auto first = static_cast<std::uint32_t>(out_.spans.size());
      for (std::uint32_t k = 0; k < sample.count; ++k) {
        out_.spans.push_back(spans_[sample.first + k]);
      }
      sample.first = first;
      sample.weight = weight * accepted_[n].weight;
      out_.lines.push_back(sample);
    }
  }

  struct Accepted {
    std::size_t line;
    double weight;
  };

  const Solid& solid_;
  bool full_;  ///< 3D: the column has two directions across
  Box box_;
  ColumnLines& out_;
  double low_, high_, middle_, reference_, tolerance_, longest_ = 0;
  int greatest_depth_;
  Spans found_, spans_;
  std::vector<ColumnLines::Sample> lines_;
  std::vector<Accepted> accepted_;
};

/// Adds the part of a span in a cell: length `d` about the height `z`, weight `w` across.
void add_piece(Frame frame, const ColumnLines::Sample& line, double d, double z, CellPart& part) {
  const double content = line.weight * d;
  const double measure =
      frame == Frame::axisymmetric ? 2 * std::numbers::pi * line.x * content : content;
  part.measure += measure;
  part.section += content;
  part.centroid[0] += measure * line.x;
  part.centroid[1] += measure * (frame == Frame::cartesian_3d ? line.y : z);
  if (frame == Frame::cartesian_3d) part.centroid[2] += measure * z;
}

void deposit(Frame frame, const ColumnLines& lines, std::span<const Box> cells, CellPart* parts) {
  const auto last = static_cast<std::size_t>(dimension(frame) - 1);
  for (const ColumnLines::Sample& line : lines.lines) {
    for (std::uint32_t n = 0; n < line.count; ++n) {
      const Span span = lines.spans[line.first + n];
      const auto reaches = [&](const Box& cell) { return cell.max[last] <= span.low; };
      auto cell = std::partition_point(cells.begin(), cells.end(), reaches);
      for (; cell != cells.end() && cell->min[last] < span.high; ++cell) {
        const double low = std::max(span.low, cell->min[last]);
        const double high = std::min(span.high, cell->max[last]);
        if (!(high > low)) continue;
        add_piece(frame, line, high - low, 0.5 * (low + high), parts[cell - cells.begin()]);
      }
    }
  }
  for (std::size_t n = 0; n < cells.size(); ++n) {
    if (!(parts[n].measure > 0)) {
      parts[n] = {};
      continue;
    }
    for (double& x : parts[n].centroid) x /= parts[n].measure;
  }
}

}  // namespace

void sample_column(const Solid& solid, Frame frame, const Box& column, double reference,
                   ColumnLines& out) {
  out.lines.clear();
  out.spans.clear();
  const int dimensions = dimension(frame);
  const Box box = in_frame(frame, column);
  if (is_empty(box, dimensions)) return;
  if (is_empty(intersection(box, solid.extent(frame), dimensions), dimensions)) return;
  Sampler(solid, frame, box, reference, out).run();
}

void Solid::clip_column(Frame frame, std::span<const Box> cells, CellPart* parts) const {
  const auto last = static_cast<std::size_t>(dimension(frame) - 1);
  Box column{};
  bool any = false;
  double thickest = 0;
  for (const Box& cell : cells) {
    const Box box = in_frame(frame, cell);
    if (is_empty(box, dimension(frame))) continue;
    if (!any) column = box;
    any = true;
    column.max[last] = box.max[last];
    thickest = std::max(thickest, box.max[last] - box.min[last]);
  }
  for (std::size_t n = 0; n < cells.size(); ++n) parts[n] = {};
  if (!any) return;
  ColumnLines lines;
  sample_column(*this, frame, column, thickest, lines);
  deposit(frame, lines, cells, parts);
}

CellPart Solid::clip(Frame frame, const Box& cell) const {
  CellPart part;
  clip_column(frame, {&cell, 1}, &part);
  return part;
}

namespace {

/// Intervals of the quadrature of a whole body, across.
constexpr int intervals_2d = 64, intervals_3d = 24;

template <class Visit>
void for_columns(Frame frame, const Box& box, Visit&& visit) {
  const int n = frame == Frame::cartesian_3d ? intervals_3d : intervals_2d;
  const auto bound = [&](int a, int i) {
    return box.min[static_cast<std::size_t>(a)] + box.length(a) * i / n;
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < (frame == Frame::cartesian_3d ? n : 1); ++j) {
      Box column = box;
      column.min[0] = bound(0, i);
      column.max[0] = bound(0, i + 1);
      if (frame == Frame::cartesian_3d) {
        column.min[1] = bound(1, j);
        column.max[1] = bound(1, j + 1);
      }
      visit(column);
    }
  }
}

Box common_box(const Solid& solid, Frame frame, const Box& domain) {
  return intersection(in_frame(frame, solid.extent(frame)), domain, dimension(frame));
}

/// A span of a line stands for a prism (3D), 1 m of y (plane strain) or a ring.
void add_span(Frame frame, const ColumnLines::Sample& line, const Span& s, VolumeMoments& sum) {
  const double z = 0.5 * (s.low + s.high), d = s.length();
  const bool ring = frame == Frame::axisymmetric;
  const double v = line.weight * d * (ring ? 2 * std::numbers::pi * line.x : 1);
  if (frame == Frame::cartesian_3d) {
    add_point(sum, v, {line.x, line.y, z});
  } else {
    add_point(sum, v, {ring ? 0 : line.x, 0, z});
    sum.second[0] += ring ? 0.5 * v * line.x * line.x : 0;
    sum.second[1] += ring ? 0.5 * v * line.x * line.x : v / 12;
  }
  sum.second[2] += v * d * d / 12;
}

}  // namespace

CellPart Solid::part(Frame frame, const Box& domain) const {
  const Box box = common_box(*this, frame, domain);
  CellPart sum;
  if (is_empty(box, dimension(frame))) return sum;
  for (int a = 0; a < dimension(frame); ++a) {
    if (!std::isfinite(box.length(a))) return {box.length(a), {}, box.length(a)};
  }
  for_columns(frame, box, [&](const Box& column) { sum += clip(frame, column); });
  return sum;
}

VolumeMoments moments_in(const Solid& solid, Frame frame, const Box& domain, bool* exact) {
  const int dimensions = dimension(frame);
  if (exact != nullptr) *exact = false;
  if (frame != Frame::plane_strain && encloses(domain, solid.extent(frame), dimensions)) {
    if (const auto known = solid.moments()) {
      if (exact != nullptr) *exact = true;
      return *known;
    }
  }
  VolumeMoments sum;
  const Box box = common_box(solid, frame, domain);
  if (is_empty(box, dimensions)) return sum;
  ColumnLines lines;
  for_columns(frame, box, [&](const Box& column) {
    sample_column(solid, frame, column, 0, lines);
    for (const ColumnLines::Sample& line : lines.lines) {
      for (std::uint32_t n = 0; n < line.count; ++n) {
        add_span(frame, line, lines.spans[line.first + n], sum);
      }
    }
  });
  return sum;
}

}  // namespace krater
