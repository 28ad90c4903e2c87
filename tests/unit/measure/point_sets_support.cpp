// SPDX-License-Identifier: GPL-3.0-or-later
#include "unit/measure/point_sets_support.hpp"

#include <cmath>
#include <numbers>

namespace krater::test {

MeasureContext measuring_domain(Frame frame, double cell, Triple min, Triple max) {
  MeasureContext context;
  context.frame = frame;
  context.h = cell;
  context.min = min;
  context.max = max;
  if (frame == Frame::axisymmetric) context.boundary[0][0] = BoundaryKind::symmetry;
  return context;
}

BodyPoints lattice_points(const MeasureContext& context, Triple low, Triple high,
                          const std::function<bool(const Triple&)>& inside, int body) {
  constexpr int kSub = 6;
  const int dim = dimension(context.frame);
  const double d = context.h / context.points_per_direction;
  BodyPoints out;
  std::array<int, 3> count{1, 1, 1}, sub{1, 1, 1};
  for (int a = 0; a < dim; ++a) {
    const auto k = static_cast<std::size_t>(a);
    count[k] = static_cast<int>(std::lround((high[k] - low[k]) / d));
    sub[k] = kSub;
  }
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) {
        const std::array<int, 3> cell{i, j, k};
        Triple centre{};
        double volume = 0, area = 0;
        for (int s = 0; s < sub[0] * sub[1] * sub[2]; ++s) {
          const std::array<int, 3> at{s % sub[0], s / sub[0] % sub[1], s / sub[0] / sub[1]};
          Triple x{};
          double part = 1;
          for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
            x[a] = low[a] + d * (cell[a] + (at[a] + 0.5) / sub[a]);
            part *= d / sub[a];
          }
          if (!inside(x)) continue;
          area += part;  // a point lies at the centroid of its area (src/README.md)
          for (std::size_t a = 0; a < 3; ++a) centre[a] += part * x[a];
          volume +=
              context.frame == Frame::axisymmetric ? 2 * std::numbers::pi * x[0] * part : part;
        }
        if (volume == 0) continue;
        for (double& c : centre) c /= area;
        out.x.push_back(centre);
        out.v.push_back({});
        out.mass.push_back(1000 * volume);
        out.density.push_back(1000);
        out.body.push_back(body);
      }
  return out;
}

BodyPoints together(BodyPoints a, const BodyPoints& b) {
  a.x.insert(a.x.end(), b.x.begin(), b.x.end());
  a.v.insert(a.v.end(), b.v.begin(), b.v.end());
  a.mass.insert(a.mass.end(), b.mass.begin(), b.mass.end());
  a.density.insert(a.density.end(), b.density.begin(), b.density.end());
  a.body.insert(a.body.end(), b.body.begin(), b.body.end());
  for (const auto& [name, values] : b.scalars)
    a.scalars[name].insert(a.scalars[name].end(), values.begin(), values.end());
  return a;
}

}  // namespace krater::test
