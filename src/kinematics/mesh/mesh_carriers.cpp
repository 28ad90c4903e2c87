// SPDX-License-Identifier: GPL-3.0-or-later
// The carriers of a step, and the nodes of the grid that they reach.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/mesh/carriers.hpp"
#include "krater/core/parallel.hpp"

namespace krater {

namespace {

constexpr std::size_t kRoom = 512;   // nodes of the box per carrier, and no more
constexpr double kReach = 3;         // cells: bodies further apart cannot meet in a step
constexpr std::size_t kChunk = 256;  // faces that are looked at as one first

Triple place_of(const MeshNodes& nodes, std::int32_t n) {
  const double* x = nodes.records + kNode * static_cast<std::size_t>(n);
  return {x[0], x[1], x[2]};
}

struct Bounds {
  Triple low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void hold(const Triple& x) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], x[a]);
      high[a] = std::max(high[a], x[a]);
    }
  }
  bool meets(const Bounds& other, double within) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (low[a] > other.high[a] + within || other.low[a] > high[a] + within) return false;
    return true;
  }
};

/// Bilinear functions of a face's corners, or linear ones of an edge's, at a point of [0, 1]^2; a
/// node on its own has one corner.
std::array<double, 4> functions_at(std::size_t corners, double s, double t) {
  if (corners == 1) return {1, 0, 0, 0};
  if (corners == 2) return {1 - s, s, 0, 0};
  return {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
}

/// The boxes of bodies of points, by their blocks.
std::vector<Bounds> bounds_of_points(const BlockGrid& grid, int bodies) {
  std::vector<Bounds> out(static_cast<std::size_t>(bodies));
  const GridGeometry& g = grid.geometry();
  const double edge = g.h * block_edge(g.dimension);
  for (const Patch& patch : grid.patches()) {
    Triple low{}, high{};
    for (std::size_t a = 0; a < static_cast<std::size_t>(g.dimension); ++a) {
      low[a] = g.min[a] + edge * patch.key.i[a] - g.h;
      high[a] = low[a] + edge + 2 * g.h;
    }
    Bounds& bounds = out[static_cast<std::size_t>(patch.body)];
    bounds.hold(low);
    bounds.hold(high);
  }
  return out;
}

}  // namespace

/// Samples of the faces that another body may touch.
void MeshContact::find_carriers() {
  const std::size_t meshes = bodies_.size();
  const auto hold = [&](std::size_t b, const Face& face, Bounds& out) {
    for (const std::int32_t n : face)
      if (n >= 0) out.hold(place_of(bodies_[b], n));
  };
  std::vector<Bounds> bounds(meshes);
  std::vector<std::vector<Bounds>> of_chunks(meshes);
  for (std::size_t b = 0; b < meshes; ++b) {
    of_chunks[b].resize((faces_[b].size() + kChunk - 1) / kChunk);
    for_each(of_chunks[b].size(), [&](std::size_t c) {
      for (std::size_t f = kChunk * c; f < faces_[b].size() && f < kChunk * (c + 1); ++f)
        hold(b, faces_[b][f], of_chunks[b][c]);
    });
    for (const Bounds& chunk : of_chunks[b]) {
      bounds[b].hold(chunk.low);
      bounds[b].hold(chunk.high);
    }
  }
  const double within = kReach * cell_;
  of_points_.clear();
  const std::vector<Bounds> points = bounds_of_points(parts_.grid, options_.fields);
  for (std::size_t p = 0; p < points.size(); ++p)
    if (std::any_of(bounds.begin(), bounds.end(),
                    [&](const Bounds& b) { return b.meets(points[p], within); })) {
      of_points_.push_back(static_cast<int>(p));
      bounds.push_back(points[p]);
    }
  for (std::size_t b = 0; b < meshes; ++b) {
    std::vector<Bounds> others;
    for (std::size_t o = 0; o < bounds.size(); ++o)
      if (o != b && bounds[b].meets(bounds[o], within)) others.push_back(bounds[o]);
    const auto near = [&](const Bounds& of) {
      return std::any_of(others.begin(), others.end(),
                         [&](const Bounds& o) { return of.meets(o, within); });
    };
    for (std::size_t f = 0; f < faces_[b].size(); ++f) {
      if (f % kChunk == 0 && !near(of_chunks[b][f / kChunk])) {
        f += kChunk - 1;
        continue;
      }
      Bounds of_face;
      hold(b, faces_[b][f], of_face);
      if (near(of_face)) sample(bodies_[b], b, faces_[b][f]);
    }
  }
}

/// Carriers of one face, no further apart than a cell.
void MeshContact::sample(const MeshNodes& nodes, std::size_t body, const Face& face) {
  const std::size_t corners = face[1] < 0 ? 1 : face[2] < 0 ? 2 : 4;
  std::array<Triple, 4> x{};
  for (std::size_t I = 0; I < corners; ++I) x[I] = place_of(nodes, face[I]);
  const auto count = [&](const Triple& along, const Triple& beside) {
    const double length = std::sqrt(std::max(dot(along, along), dot(beside, beside)));
    // An edge of one cell has one sample, however it was rounded.
    return std::clamp(static_cast<int>(std::ceil(length / cell_ - 1e-6)), 1, 64);
  };
  const int ns =
      corners == 1 ? 1 : count(minus(x[1], x[0]), corners == 2 ? Triple{} : minus(x[2], x[3]));
  const int nt = corners < 4 ? 1 : count(minus(x[3], x[0]), minus(x[2], x[1]));
  for (int i = 0; i < ns; ++i)
    for (int j = 0; j < nt; ++j) {
      const double s = (i + 0.5) / ns, t = (j + 0.5) / nt;
      Carrier q{};
      q.body = body;
      q.nodes = face;
      q.corners = corners;
      q.share = functions_at(corners, s, t);
      Triple by_s{}, by_t{};
      for (std::size_t I = 0; I < corners; ++I) add_to(q.x, q.share[I], x[I]);
      if (corners == 2) {  // outwards is to the right of an edge
        const Triple along = minus(x[1], x[0]);
        const double round = frame_ == Frame::axisymmetric ? 2 * std::numbers::pi * q.x[0] : 1.0;
        q.area = {round * along[1] / ns, -round * along[0] / ns, 0};
      } else if (corners == 4) {
        add_to(by_s, 1 - t, minus(x[1], x[0]));
        add_to(by_s, t, minus(x[2], x[3]));
        add_to(by_t, 1 - s, minus(x[3], x[0]));
        add_to(by_t, s, minus(x[2], x[1]));
        add_to(q.area, 1.0 / (ns * nt), cross(by_s, by_t));
      }
      for (int a = 0; a < dim_; ++a) {
        const auto k = static_cast<std::size_t>(a);
        const double u = geometry_.knots(q.x[k], a), base = Support::base(u), f = u - base + 0.5;
        q.base[k] = static_cast<int>(base);
        q.weight[k] = {0.5 * (1.5 - f) * (1.5 - f), 0.75 - (f - 1) * (f - 1),
                       0.5 * (f - 0.5) * (f - 0.5)};
      }
      carriers_.push_back(q);
    }
}

/// N_I -> m_qI.
void MeshContact::share_masses() {
  std::vector<std::vector<double>> whole;
  for (const MeshNodes& b : bodies_) whole.emplace_back(b.count, 0.0);
  for (const Carrier& q : carriers_)
    for (std::size_t I = 0; I < q.corners; ++I)
      whole[q.body][static_cast<std::size_t>(q.nodes[I])] += q.share[I] * length_of(q.area);
  for (Carrier& q : carriers_)
    for (std::size_t I = 0; I < q.corners; ++I) {
      const auto n = static_cast<std::size_t>(q.nodes[I]);
      const double all = whole[q.body][n];
      const double part = q.corners == 1 ? 1.0
                          : all > 0      ? q.share[I] * length_of(q.area) / all
                                         : 0.0;
      q.share[I] = bodies_[q.body].records[kNode * n + kMass] * part;
    }
}

/// The node of the grid that holds what lies at `index`: an image's is inside.
MeshContact::Reached MeshContact::inside(Index& index) const {
  Reached out{};
  for (int a = 0; a < dim_; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const int last = geometry_.cells[k] + 1;
    const bool low = conditions_[k][0].kind == BoundaryKind::symmetry && index[k] < 1,
               high = conditions_[k][1].kind == BoundaryKind::symmetry && index[k] > last;
    if (!low && !high) continue;
    index[k] = low ? 2 - index[k] : 2 * last - index[k];
    out.flips = static_cast<std::uint8_t>(out.flips | (1U << k));
  }
  return out;
}

namespace {

/// Numbers of nodes in a box, in order of their places.
struct NodeBox {
  std::array<int, 3> low{1 << 30, 1 << 30, 1 << 30}, high{-(1 << 30), -(1 << 30), -(1 << 30)};
  std::vector<std::int32_t> number;

  void hold(const std::array<int, 3>& index) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], index[a]);
      high[a] = std::max(high[a], index[a]);
    }
  }
  std::size_t length(std::size_t a) const { return static_cast<std::size_t>(high[a] - low[a] + 1); }
  std::size_t size() const { return length(0) * length(1) * length(2); }
  std::size_t place(const std::array<int, 3>& index) const {
    std::size_t n = 0;
    for (std::size_t a = 0; a < 3; ++a)
      n = n * length(a) + static_cast<std::size_t>(index[a] - low[a]);
    return n;
  }
};

}  // namespace

/// The nodes of the grid that carriers reach, in order of their places. Where bodies are close the
/// box around them is a few cells thick, and mostly full; if not, they are sorted.
void MeshContact::number_nodes() {
  const auto visit_nodes = [&](Carrier& q, const auto& visit) {
    std::size_t n = 0;
    for (int i = 0; i < static_cast<int>(kSupport); ++i)
      for (int j = 0; j < static_cast<int>(kSupport); ++j)
        for (int k = 0; k < (dim_ == 3 ? static_cast<int>(kSupport) : 1); ++k) {
          Index index{q.base[0] + i, q.base[1] + j, q.base[2] + k};
          q.at[n].flips = inside(index).flips;
          visit(q.at[n++], index);
        }
  };
  NodeBox box;
  for (const Carrier& q : carriers_)
    for (const int corner : {0, static_cast<int>(kSupport) - 1}) {
      Index seen{q.base[0] + corner, q.base[1] + corner,
                 dim_ == 3 ? q.base[2] + corner : q.base[2]};
      Index at_most = seen;  // from across a plane of symmetry images reach back to the plane
      for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
        at_most[a] = std::clamp(seen[a], 1, geometry_.cells[a] + 1);
      const bool mirrored = inside(seen).flips != 0;
      box.hold(seen);
      if (mirrored) box.hold(at_most);
    }
  places_.clear();
  if (box.size() > kRoom * carriers_.size()) {
    for (Carrier& q : carriers_)
      visit_nodes(q, [&](Reached&, const Index& index) { places_.push_back(index); });
    std::sort(places_.begin(), places_.end());
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
    for (Carrier& q : carriers_)
      visit_nodes(q, [&](Reached& at, const Index& index) {
        at.node = static_cast<std::int32_t>(
            std::lower_bound(places_.begin(), places_.end(), index) - places_.begin());
      });
    return;
  }
  box.number.assign(box.size(), -1);
  for (Carrier& q : carriers_)
    visit_nodes(q, [&](Reached& at, const Index& index) {
      const std::size_t place = box.place(index);
      box.number[place] = 0;
      at.node = static_cast<std::int32_t>(place);
    });
  std::size_t place = 0;
  for (int i = box.low[0]; i <= box.high[0]; ++i)
    for (int j = box.low[1]; j <= box.high[1]; ++j)
      for (int k = box.low[2]; k <= box.high[2]; ++k)
        if (std::int32_t& number = box.number[place++]; number == 0) {
          number = static_cast<std::int32_t>(places_.size());
          places_.push_back({i, j, k});
        }
  for (Carrier& q : carriers_)
    for (std::size_t n = 0; n < reached(); ++n)
      q.at[n].node = box.number[static_cast<std::size_t>(q.at[n].node)];
}

}  // namespace krater
