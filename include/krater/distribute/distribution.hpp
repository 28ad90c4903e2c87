// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file distribute/distribution.hpp
/// Blocks of one scene on several ranks, with the bits of one.
///
/// Every rank knows of all patches: key, body, owner, how many points, and what their last sweep
/// found (PatchResult); so what is summed or decided over patches is so on every rank as on one.
/// The points of a patch are on its owner alone. A rank also holds, without points, the patches up
/// to `width` blocks around its own (grid/neighbourhood.hpp): their tiles come from their owners
/// once a step, and the nodes around its own points are summed, moved, brought into contact and
/// held by walls here, from all tiles that reach them in the order of their blocks, as one rank
/// does it. Nothing is sent back.
///
/// How far that reaches: a point reads the nodes of its block and the one above it, [0, 1]; these
/// are whole with the tiles of [-1, 1]. Each of the following reads nodes up to a block further on
/// to make those right: planes that fold or push, contact, planes that push along two axes, and
/// levels of cells.
///
/// A sum over nodes counts a block where the first patch that reaches it is (NodeBlock::counted),
/// and does not depend on the order of its terms (core/reproducible_sum.hpp).
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "krater/core/ranks.hpp"
#include "krater/distribute/partition.hpp"
#include "krater/grid/blocks.hpp"
#include "krater/kinematics/audit.hpp"
#include "krater/points/columns.hpp"

namespace krater {

class Distribution {
 public:
  /// `columns`: by body.
  Distribution(int dimension, int width, std::vector<PointColumns> columns)
      : width_{width}, columns_{std::move(columns)}, partition_{dimension} {}

  /// At the start, or of a checkpoint: who will have these blocks. The grid's patches are made and
  /// filled after it.
  void deal(BlockGrid& grid, const std::map<BlockKey, double>& points);
  /// Shares anew where the most that a rank has to do is more than 1.15 of the mean; true: they
  /// are. Relink afterwards.
  bool rebalance(BlockGrid& grid);
  /// Who needs whose tiles; after BlockGrid::rebuild().
  void relink(const BlockGrid& grid);
  int owner(const BlockKey& key) const { return partition_.owner(key); }
  /// Of patches near those of other ranks: what write(p, numbers) adds, to these ranks, where
  /// read(p, at) takes it and moves on; p: number of the patch. Collective.
  template <class Write, class Read>
  void exchange_near(const Write& write, const Read& read) const {
    std::vector<ranks::Message> out;
    std::vector<int> from;
    for (const Neighbour& n : neighbours_) {
      out.push_back({n.rank, {}});
      from.push_back(n.rank);
      for (const int p : n.send) write(static_cast<std::size_t>(p), out.back().data);
    }
    const std::vector<ranks::Message> in = ranks::exchange(out, from);
    for (std::size_t m = 0; m < in.size(); ++m) {
      const double* at = in[m].data.data();
      for (const int p : neighbours_[m].receive) read(static_cast<std::size_t>(p), at);
    }
  }
  /// To whatever ranks: a message for each rank, empty or not; what comes, by rank.
  static std::vector<ranks::Message> exchange_any(std::vector<std::vector<double>> by_rank);
  /// Tiles of patches near those of other ranks: when all that goes out is scattered, and before
  /// those are read that come.
  void send_tiles(BlockGrid& grid);
  void receive_tiles(BlockGrid& grid);
  /// The tile of a patch is one of these.
  bool goes_out(std::size_t patch) const { return goes_out_[patch] != 0; }
  /// What the sweep found of each patch, and what it took out of the computation, to all.
  void share_results(BlockGrid& grid, std::vector<Removed>& removed) const;
  /// Of patches, by number: what the owner found, to all.
  template <class T>
  void share(const BlockGrid& grid, std::vector<T>& found) const {
    static_assert(std::is_trivially_copyable_v<T>);
    share_bytes(grid, sizeof(T), std::as_writable_bytes(std::span{found}));
  }
  void share_keys(const BlockGrid& grid, std::vector<std::vector<BlockKey>>& found) const;
  /// Points that leave a patch for one of another rank, into the outbox of that patch there.
  void send_points(BlockGrid& grid) const;
  /// How many points patches have now.
  void share_counts(BlockGrid& grid) const;
  /// All points to the first rank, for it to write and measure; and away again.
  void assemble(BlockGrid& grid) const;
  void release(BlockGrid& grid) const;

  /// The most that a rank has to do over the mean, by measured time; 1 is balance.
  double imbalance(const BlockGrid& grid) const;
  int times_cut() const { return cuts_; }

 private:
  struct Neighbour {
    int rank;
    std::vector<int> send, receive;  ///< patches, in their order
  };
  Neighbour& neighbour(int rank);
  void share_bytes(const BlockGrid& grid, std::size_t size, std::span<std::byte> found) const;

  int width_;
  std::vector<PointColumns> columns_;
  Partition partition_;
  std::vector<Neighbour> neighbours_;            ///< by rank
  std::vector<ranks::Message> sent_, received_;  ///< tiles, by neighbour; their memory stays
  std::vector<char> goes_out_;                   ///< by patch
  /// Patches of this rank whose tile a rank has had since it needs it: (rank, body, key).
  std::set<std::pair<std::pair<int, int>, BlockKey>> known_;
  int steps_since_cut_ = 0, cuts_ = 0;
};

}  // namespace krater
