// SPDX-License-Identifier: GPL-3.0-or-later
// Seeds of one lattice of constant spacing: columns are clipped in parallel, slab by slab of equal
// i, and joined in order; then slivers are given away (lattice.hpp, `fill`).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/seeds/lattice_cells.hpp"

namespace krater {

class Filler {
 public:
  Filler(const Solid& solid, Frame frame, const LatticeOptions& options, const Box& domain);

  std::vector<SeedPoint> run(FillReport& report);
  const Box& region() const { return region_; }

 private:
  using Slot = std::int32_t;
  struct Sliver {
    CellIndex at;
    CellPart part;
  };
  /// What comes out of the columns with one i.
  struct Slab {
    std::vector<SeedPoint> points;
    std::vector<std::uint32_t> cut;  ///< points of cells that are not whole
    std::vector<Sliver> slivers;
  };
  struct Gift {
    std::size_t sliver;
    Slot to;
    double share;
    int axis;  ///< along which giver and taker touch; -1 at an edge or corner
  };
  /// Kept cells about a sliver, the best score among them, and where each touches it.
  struct Best {
    double score = 0;
    std::size_t count = 0;
    std::array<double, 26> scores{};
    std::array<Slot, 26> to{};
    std::array<int, 26> axis{};
  };

  void visit_cells();
  void visit_slab(std::int64_t i, Slab& slab);
  void visit_column(CellIndex c, Slab& slab, std::vector<Box>& boxes, std::vector<CellPart>& parts);
  void join(std::vector<Slab>& slabs);
  SeedPoint seed(const CellPart& part, const Box& clipped) const;
  double content(const SeedPoint& point) const;
  void consider(Best& best, const CellIndex& c, double overlap, int axis) const;
  Best face_gifts(const CellIndex& c) const;
  Best corner_gifts(const CellIndex& c) const;
  void give(std::vector<std::size_t>& pending, Best (Filler::*choose)(const CellIndex&) const);
  void absorb(const Gift& gift);
  void keep_fullest(std::vector<std::size_t>& pending, FillReport& report);
  void pull_inside();
  void pull_inside(SeedPoint& point) const;

  const Solid& solid_;
  Frame frame_;
  int dimensions_;
  Box region_;  ///< the domain's part of the solid's bounding box
  LatticeCells cells_;
  std::array<double, 3> spacing_;
  std::vector<Slot> slots_;  ///< of every cell of the region: its point, or nothing
  std::vector<SeedPoint> points_;
  std::vector<bool> cut_;  ///< of every point: its part is not a whole cell
  std::vector<Sliver> slivers_;
};

}  // namespace krater
