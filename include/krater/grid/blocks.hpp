// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file grid/blocks.hpp
/// The sparse background grid and who lies where. Space is cut into blocks of block_edge^dim nodes.
/// A patch holds the points of one body whose base node lies in one block, with a private tile of
/// nodes they scatter into; a node block sums the tiles that overlap it in a fixed order. Blocks
/// exist only where points are, so the size of the domain costs nothing, and nothing depends on the
/// number of threads.
///
/// Every body belongs to a velocity field, and every field has node blocks of its own: bodies of
/// one field stick together, fields know nothing of each other until contact or, with a fixed
/// reference configuration, for ever.
///
/// Blocks of several levels stand side by side (grid/levels.hpp); those of one level know nothing
/// of the others' nodes but through the tied ones (kinematics/mpm/ties.hpp). How nodes are counted:
/// grid/geometry.hpp.
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "krater/core/aligned.hpp"
#include "krater/core/batch_types.hpp"
#include "krater/grid/geometry.hpp"
#include "krater/grid/key_index.hpp"
#include "krater/grid/levels.hpp"
#include "krater/grid/node_record.hpp"
#include "krater/points/store.hpp"

namespace krater {

/// A velocity field of the grid. It is no body: a type of its own keeps one index from being taken
/// for the other, which are the same number only where every body has a field of its own.
enum class FieldId : int {};
/// There: with contact, or on a fixed reference configuration.
constexpr int body_of(FieldId field) { return static_cast<int>(field); }
constexpr FieldId own_field(int body) { return static_cast<FieldId>(body); }

/// Points that leave a patch: whole records, point by point, with the neighbour they go to.
struct Outbox {
  std::vector<double> records;
  std::vector<std::uint8_t> slots;  ///< neighbour 0..26, lexicographic in (-1, 0, 1) per axis
  std::uint32_t used = 0;           ///< bit per slot, and this one:
  static constexpr std::uint32_t kOtherLevel = 1U << 31U;
  std::vector<double> other_level;  ///< whole records of points for blocks of another level ...
  std::vector<BlockKey> keys;       ///< ... and these blocks
  void clear() {
    other_level.clear();
    keys.clear();
    records.clear();
    slots.clear();
    used = 0;
  }
};

/// What one sweep over a patch leaves behind; combined over patches in patch order.
struct PatchResult {
  double max_rate = 0;     ///< 1/dt at CFL 1, theory 12 [1/s]
  int limiter = 0;         ///< 0 wave, 1 flow, 2 dilatation
  int limiting_point = 0;  ///< index in the patch; after the gather the point's id
  int crossed = 0;  ///< of a rigid body: 1 + 2 axis + closed side that a point has crossed; 0: none
  double kinetic = 0;                     ///< [J], affine part included
  double internal = 0;                    ///< [J]
  double external_work = 0;               ///< [J] of body forces in the step
  double heat_given = 0, heat_taken = 0;  ///< [J] of the ledger, sums over cells with either sign
  std::array<double, 3> cut_impulse{};    ///< [N s] of sides that fold, on the points of cut cells
  double carried = 0, carriers = 0;       ///< [J] owed by points, negative; cells that came short
  double stretch = 0;                     ///< fixed reference: largest |F^T F - I|
  Ledger ledger;
  Fault fault;
};

/// The nodes that the points of a patch scatter into, and what they hold.
struct Tile {
  enum class State {
    stale,   ///< of an earlier state of the points
    ahead,   ///< of the present one, scattered in the sweep that made it
    asleep,  ///< of the present one, and the last sweep changed no bit of the points
  };
  AlignedBuffer nodes;  ///< tile_nodes * kNodeDoubles
  State state = State::stale;
  KRATER_FORCE_INLINE double* data() { return nodes.data(); }
  KRATER_FORCE_INLINE const double* data() const { return nodes.data(); }
};

/// Where a patch lies among the others, filled by BlockGrid::rebuild().
struct PatchLinks {
  std::array<int, 8> node_blocks{};  ///< at key + {0,1}^dim
  std::array<int, 27> neighbours{};  ///< patches of the same body at key + {-1,0,1}^dim, -1: none
};

/// Two patches share no cache line (nor a pair of them): neighbours are swept by different threads.
struct alignas(128) Patch {
  BlockKey key;
  int body = 0;
  FieldId field{};  ///< velocity field of the body, filled by rebuild
  PointStore points;
  Tile tile;
  AlignedBuffer beta;           ///< per cell: 1 averaged .. 0 shock
  AlignedBuffer pressure_tile;  ///< of a fluid, as long as `tile`, then a weight per cell
  bool owns_cells = false;      ///< the first fluid of its field in its block
  bool settled = false;         ///< the last gather found everything at rest and changed nothing
  bool steady = false;          ///< no point came or left in the last step
  bool awaited = false;         ///< points were to come soon when patches were made last
  int rank = -1;                ///< that has its points (distribute/distribution.hpp)
  int held = 0;                 ///< how many these are, where another rank has them
  bool here = true;             ///< this rank has them ...
  bool near = true;             ///< ... or its tile at least
  double cost = 0;              ///< of its sweeps, smoothed over steps, where there are ranks [s]
  PatchLinks links;
  Outbox outbox;
  PatchResult result;

  /// Points that are in it, on whatever rank.
  int count() const { return here ? points.count() : held; }
  /// The points, or some of them, were changed from outside the sweeps.
  void touch() {
    settled = false;
    tile.state = Tile::State::stale;
  }
  /// One point as stride/8 doubles; points.pad() afterwards.
  void append(const double* point) {
    touch();
    steady = false;
    points.append(point);
  }
};

struct TileRef {
  int patch;
  int corner;  ///< bit a set: the patch lies one block below along axis a
};

/// Sums of one node block, combined in block order.
struct NodeSums {
  double kinetic = 0;     ///< 1/2 sum m |v^+|^2 [J]
  double max_change = 0;  ///< max |dv| over nodes that hold material [m/s]
};

struct NodeBlock {
  BlockKey key;
  FieldId field{};
  int first_tile = 0, tiles = 0;  ///< range of BlockGrid::tile_refs
  std::uint64_t tied = 0;         ///< nodes that follow from those of the level above, a bit each
  bool at_tie = false;            ///< holds such nodes, some that they follow from, or next to them
  bool completed = false;         ///< contact adds the volumes of finer nodes: never passed over
  bool at_boundary = false;
  bool at_wall = false;  ///< holds columns of a unilateral wall
  bool whole = true;     ///< all its tiles are of this rank
  bool counted = true;   ///< in the sums of this rank: it has the first patch that reaches it
  bool still = false;    ///< every v+ and dv of the block is exactly zero
  bool inert =
      false;  ///< and so were its momenta and forces: nothing to compute while its tiles stay
  double* nodes = nullptr;  ///< kBlockNodes * kNodeDoubles
  NodeSums sums;
};

/// A block at rest, whose tiles may not be summed again, keeps its volumes: there k is zero.
inline bool keeps_volumes(const NodeBlock& block) { return block.still && !block.at_boundary; }

class BlockGrid {
 public:
  explicit BlockGrid(const GridGeometry& geometry) : levels_{geometry} {}

  const GridGeometry& geometry(int level = 0) const { return levels_.geometry(level); }
  const Levels& levels() const { return levels_; }
  /// Points must be sorted anew when it changes; true: it does.
  bool set_levels(BlockSet refined) { return levels_.set(std::move(refined)); }
  /// Sorted by (key, body) after rebuild().
  std::span<Patch> patches() { return patches_; }
  KRATER_FORCE_INLINE const std::vector<Patch>& patches() const { return patches_; }
  /// Sorted by (key, field).
  std::span<NodeBlock> node_blocks() { return node_blocks_; }
  KRATER_FORCE_INLINE const std::vector<NodeBlock>& node_blocks() const { return node_blocks_; }
  KRATER_FORCE_INLINE const std::vector<TileRef>& tile_refs() const { return tile_refs_; }
  /// All node blocks lie in one piece of memory, in their order.
  KRATER_FORCE_INLINE double* nodes() { return node_memory_.data(); }
  KRATER_FORCE_INLINE const double* nodes() const { return node_memory_.data(); }

  /// A patch without points; rebuild() afterwards. Indices and references of patches change.
  Patch& add_patch(const BlockKey& key, int body, int stride);
  /// Drop the patches of a body, or all of them; rebuild() afterwards.
  void drop_patches(int body = -1);
  /// Or those of which `drop` is true.
  template <class Drop>
  void drop_patches_if(const Drop& drop) {
    std::erase_if(patches_, drop);
  }
  /// Node blocks whose volumes contact reads near finer cells are there too. Before rebuild().
  void keep_shadows() { shadows_ = true; }
  /// Velocity field of each body; bodies beyond the list are in field 0. Before rebuild().
  void set_fields(std::vector<FieldId> field_of_body) { field_of_body_ = std::move(field_of_body); }
  /// Which rank has the patches of a block; this one is `own` and holds the nodes and tiles of what
  /// is near its patches (grid/neighbourhood.hpp). Before patches are made.
  void set_owners(std::function<int(const BlockKey&)> owner, int own, int width) {
    owner_ = std::move(owner);
    own_ = own;
    width_ = width;
  }
  int find_patch(const BlockKey& key, int body) const;            ///< -1: none
  int find_node_block(const BlockKey& key, FieldId field) const;  ///< -1: none
  /// The block of a node, or of a cell, and which it is there.
  std::pair<BlockKey, int> place_of_node(const std::array<int, 3>& storage_index,
                                         int level = 0) const;
  /// nullptr: not stored
  double* find_node(const std::array<int, 3>& storage_index, FieldId field, int level = 0) const;
  /// Sort patches, drop empty ones if asked, lay out node blocks and all links.
  void rebuild(bool drop_empty);

 private:
  void find_near();
  void count_masters();
  void make_node_blocks();
  template <class Add>
  void add_shadows(const Add& add);
  void link_patches();

  Levels levels_;
  std::vector<Patch> patches_;
  std::vector<NodeBlock> node_blocks_;
  std::vector<TileRef> tile_refs_;
  std::vector<FieldId> field_of_body_;
  bool shadows_ = false;
  std::function<int(const BlockKey&)> owner_;  ///< empty: one rank has all
  int own_ = 0, width_ = 0;
  KeyIndex patch_index_, node_index_;
  AlignedBuffer node_memory_;
};

/// Offset of neighbour `slot` (0..3^dim-1) or corner (bits) along an axis.
constexpr int slot_offset(int slot, int axis, int dimension) {
  int power = 1;
  for (int a = dimension - 1; a > axis; --a) power *= 3;
  return (slot / power) % 3 - 1;
}
constexpr int corner_offset(int corner, int axis) { return (corner >> axis) & 1; }
BlockKey shifted(const BlockKey& key, int slot, int dimension);
/// One of the blocks that hold what the tied nodes of block `key` follow from: 2^dim where its
/// indices are odd, fewer where some are even. None: of that corner there is none.
std::optional<BlockKey> master_block(const BlockKey& key, int corner, int dimension);

}  // namespace krater
