// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/interior.hpp
/// Is a body all around a point? Where the cell of the point and its 3^dim - 1 neighbours, all of
/// the size of the point's own level, hold at least 0.7 of the mass that the undeformed body has
/// there (one point of four may lie next door). Beyond a side that folds and does not lie across
/// the last axis the body goes on; any other side is where it ends.
///
/// By the points and not by the nodes' volumes: these are gone where blocks were laid out anew in
/// the same step. Points under way between blocks count where they are going.
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "krater/contact/boundary.hpp"
#include "krater/distribute/distribution.hpp"
#include "krater/kinematics/mpm/kernels.hpp"
#include "krater/kinematics/mpm/split.hpp"

namespace krater {

class Interior {
 public:
  /// While points are under way: between the sweep that fills the outboxes and their delivery. All
  /// references must outlive it.
  Interior(const BlockGrid& grid, const BoundaryConditions& conditions,
           const std::vector<BodyKernelData>& bodies, const std::vector<PointSize>& sizes)
      : grid_{grid}, conditions_{conditions}, bodies_{bodies}, sizes_{sizes} {}
  /// What other ranks have near the points of this one. Collective.
  void exchange(const Distribution& ranks);

  bool holds(const double* position, int level, int body);

 private:
  /// Masses of the cells of a block, by their order in it [kg].
  using Masses = std::array<double, kBlockNodes>;
  using Cell = std::array<int, 3>;
  struct CellKey {
    Cell cell;
    int level, body;
    auto operator<=>(const CellKey&) const = default;
  };
  enum class Side { inside, image, end };

  /// A point on its way.
  struct Traveller {
    BlockKey to;
    int cell;  ///< of the block
    double mass;
  };
  Masses masses_of(const Patch& patch) const;
  std::vector<Traveller> travellers_of(const Patch& patch) const;
  Side side_of(const Cell& cell, const GridGeometry& geometry) const;
  bool full(const CellKey& key);
  double mass(const Cell& cell, int level, int body);
  const Masses& masses(const BlockKey& key, int body);
  void add_travellers();
  int cell_in_block(const GridGeometry& geometry, const double* position) const;

  const BlockGrid& grid_;
  const BoundaryConditions& conditions_;
  const std::vector<BodyKernelData>& bodies_;
  const std::vector<PointSize>& sizes_;
  bool counted_ = false;  ///< the points under way
  std::map<std::pair<BlockKey, int>, Masses> travelling_, masses_;
  /// Of patches of other ranks.
  std::map<std::pair<BlockKey, int>, Masses> masses_there_;
  std::map<std::pair<BlockKey, int>, std::vector<Traveller>> travellers_there_;
  std::map<CellKey, bool> full_;
};

}  // namespace krater
