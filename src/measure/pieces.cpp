// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/measure/pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "krater/grid/key_index.hpp"

namespace krater {

namespace {

constexpr double kFarthest = 1 << 30;  // cells: a key is 32 bits wide

struct Cell {
  BlockKey key;
  int body;
  bool holds;  ///< not of rubble alone
};

class Forest {
 public:
  void add() { parent_.push_back(static_cast<int>(parent_.size())); }
  int root(int i) {
    while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }
  /// The lower index becomes the root: no order of joining changes the roots.
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    parent_[at(std::max(a, b))] = std::min(a, b);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  std::vector<int> parent_;
};

BlockKey cell_of(const Triple& x, const MeasureContext& context) {
  BlockKey key;
  for (int d = 0; d < dimension(context.frame); ++d) {
    const auto a = static_cast<std::size_t>(d);
    const double cell = std::floor((x[a] - context.min[a]) / context.h);
    key.i[a] = static_cast<std::int32_t>(std::clamp(cell, -kFarthest, kFarthest));
  }
  return key;
}

/// Half of the neighbours: the other half sees this cell.
std::vector<BlockKey> forward_neighbours(int dimension) {
  std::vector<BlockKey> steps;
  const int z = dimension == 3 ? 1 : 0;
  for (int i = 0; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -z; k <= z; ++k)
        if (BlockKey{} < BlockKey{{i, j, k}}) steps.push_back({{i, j, k}});
  return steps;
}

/// The occupied cells, and that of every point.
std::vector<Cell> occupied_cells(const BodyPoints& points, const MeasureContext& context,
                                 KeyIndex& index, std::vector<int>& of) {
  index.clear(points.count());
  of.resize(points.count());
  std::vector<Cell> cells;
  for (std::size_t p = 0; p < points.count(); ++p) {
    const BlockKey key = cell_of(points.x[p], context);
    const int body = points.body_of(p);
    const bool same = p > 0 && cells[static_cast<std::size_t>(of[p - 1])].key == key &&
                      cells[static_cast<std::size_t>(of[p - 1])].body == body;
    of[p] = same ? of[p - 1] : index.find(key, body);
    if (of[p] < 0) {
      of[p] = static_cast<int>(cells.size());
      index.insert(key, body, of[p]);
      cells.push_back({key, body, false});
    }
    if (!points.is_rubble(p)) cells[static_cast<std::size_t>(of[p])].holds = true;
  }
  return cells;
}

void add_point(Piece& piece, const BodyPoints& points, std::size_t p) {
  const double m = points.mass[p];
  piece.body = points.body_of(p);
  piece.points += 1;
  piece.mass += m;
  for (std::size_t a = 0; a < 3; ++a) {
    piece.velocity[a] += m * points.v[p][a];
    piece.centre[a] += m * points.x[p][a];
    piece.low[a] = std::min(piece.low[a], points.x[p][a]);
    piece.high[a] = std::max(piece.high[a], points.x[p][a]);
  }
}

}  // namespace

Pieces connected_pieces(const BodyPoints& points, const MeasureContext& context) {
  KeyIndex index;
  std::vector<int> of;
  const std::vector<Cell> cells = occupied_cells(points, context, index, of);
  Forest forest;
  for (std::size_t c = 0; c < cells.size(); ++c) forest.add();
  const std::vector<BlockKey> steps = forward_neighbours(dimension(context.frame));
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const BlockKey& step : steps) {
      BlockKey key = cells[c].key;
      for (std::size_t a = 0; a < 3; ++a) key.i[a] += step.i[a];
      const int beside = index.find(key, cells[c].body);
      if (beside >= 0 && (cells[c].holds || cells[static_cast<std::size_t>(beside)].holds))
        forest.join(static_cast<int>(c), beside);
    }

  constexpr double inf = std::numeric_limits<double>::infinity();
  std::vector<Piece> found;
  std::vector<int> piece_of(cells.size(), -1);  // by root
  std::vector<int> first(points.count());
  for (std::size_t p = 0; p < points.count(); ++p) {
    int& piece = piece_of[static_cast<std::size_t>(forest.root(of[p]))];
    if (piece < 0) {
      piece = static_cast<int>(found.size());
      found.push_back({.low = {inf, inf, inf}, .high = {-inf, -inf, -inf}});
    }
    first[p] = piece;
    add_point(found[static_cast<std::size_t>(piece)], points, p);
  }

  std::vector<int> order(found.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&found](int a, int b) {
    return found[static_cast<std::size_t>(a)].mass > found[static_cast<std::size_t>(b)].mass;
  });
  Pieces result;
  std::vector<int> rank(found.size());
  std::map<int, int> number;
  for (const int old : order) {
    rank[static_cast<std::size_t>(old)] = static_cast<int>(result.list.size());
    Piece piece = found[static_cast<std::size_t>(old)];
    piece.number = number[piece.body]++;
    for (std::size_t a = 0; a < 3; ++a) {
      piece.velocity[a] /= piece.mass;
      piece.centre[a] /= piece.mass;
    }
    result.list.push_back(piece);
  }
  for (const int old : first) result.of.push_back(rank[static_cast<std::size_t>(old)]);
  return result;
}

}  // namespace krater
