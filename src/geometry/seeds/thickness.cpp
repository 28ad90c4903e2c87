// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/seeds/thickness.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace krater {
namespace {

constexpr std::size_t most_samples = 2000;
constexpr double inf = std::numeric_limits<double>::infinity();

/// Length of the chord through x along an axis, mirrors included; infinite where none is found.
double chord(const Solid& solid, Frame frame, const std::array<double, 3>& x, int axis,
             const Box& domain, const MirrorSides& mirrors) {
  const auto a = static_cast<std::size_t>(axis);
  const double round_off = 1e-9 * domain.length(axis);
  // The other half of a body of revolution is there without a mirror.
  const bool ring = frame == Frame::axisymmetric && axis == 0 && domain.min[0] <= 0;
  Spans found;
  solid.spans(along_axis(to_space(frame, x), tensor_axis(frame, axis)), found);
  for (const Span& s : found) {
    if (x[a] < s.low - round_off || x[a] > s.high + round_off) continue;
    const double low = ring ? s.low : std::max(s.low, domain.min[a]);
    const double high = std::min(s.high, domain.max[a]);
    const bool below = !ring && mirrors[a][0] && s.low <= domain.min[a] + round_off;
    const bool above = mirrors[a][1] && s.high >= domain.max[a] - round_off;
    if (below && above) return inf;
    return (below || above ? 2 : 1) * (high - low);
  }
  return inf;
}

}  // namespace

double thickness_of_share(const Solid& solid, Frame frame, const std::vector<SeedPoint>& points,
                          const Box& domain, const MirrorSides& mirrors, double share) {
  const std::size_t stride = points.size() / most_samples + 1;
  std::vector<std::pair<double, double>> samples;
  double total = 0;
  for (std::size_t n = 0; n < points.size(); n += stride) {
    double least = inf;
    for (int axis = 0; axis < dimension(frame); ++axis) {
      least = std::min(least, chord(solid, frame, points[n].x, axis, domain, mirrors));
    }
    samples.emplace_back(least, points[n].measure);
    total += points[n].measure;
  }
  std::sort(samples.begin(), samples.end());
  double sum = 0;
  for (const auto& [thickness, measure] : samples) {
    sum += measure;
    if (sum >= share * total) return thickness;
  }
  return 0;
}

}  // namespace krater
