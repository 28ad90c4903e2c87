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
/// Nodes are counted from the lower domain plane, shifted by one: the plane is storage index 1, the
/// ghost beyond it 0.
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "krater/core/aligned.hpp"
#include "krater/core/batch_types.hpp"
#include "krater/grid/key_index.hpp"
#include "krater/grid/node_record.hpp"
#include "krater/grid/support.hpp"
#include "krater/points/store.hpp"

namespace krater {

inline constexpr int kBlockNodes = 64;  ///< nodes (and cells) of a block: 4^3 or 8^2
constexpr int block_edge(int dimension) { return dimension == 3 ? 4 : 8; }
constexpr int tile_edge(int dimension) { return block_edge(dimension) + Support::support - 1; }
constexpr int tile_nodes(int dimension) {
  const int edge = tile_edge(dimension);
  return dimension == 3 ? edge * edge * edge : edge * edge;
}
constexpr int corner_count(int dimension) { return dimension == 3 ? 8 : 4; }      ///< 2^dim
constexpr int neighbour_count(int dimension) { return dimension == 3 ? 27 : 9; }  ///< 3^dim

struct GridGeometry {
  int dimension = 3;
  double h = 1, inv_h = 1;
  std::array<double, 3> min{};  ///< lower domain planes [m]
  std::array<int, 3> cells{};   ///< number of cells; upper planes at storage index cells + 1
  /// Storage coordinate: 1 on the lower plane. The same expression decides weights and ownership.
  double storage(double x, int axis) const {
    return (x - min[static_cast<std::size_t>(axis)]) * inv_h + 1;
  }
  double upper(int axis) const {
    return min[static_cast<std::size_t>(axis)] + h * cells[static_cast<std::size_t>(axis)];
  }
};

/// A velocity field of the grid. It is no body: a type of its own keeps one index from being taken
/// for the other, which are the same number only where every body has a field of its own.
enum class FieldId : int {};
/// There: with contact, or on a fixed reference configuration.
constexpr int body_of(FieldId field) { return static_cast<int>(field); }
constexpr FieldId own_field(int body) { return static_cast<FieldId>(body); }

/// The block that owns a position of `dimension` coordinates.
BlockKey block_of(const GridGeometry& geometry, const double* position);

/// Points that leave a patch: whole records, point by point, with the neighbour they go to.
struct Outbox {
  std::vector<double> records;
  std::vector<std::uint8_t> slots;  ///< neighbour 0..26, lexicographic in (-1, 0, 1) per axis
  std::uint32_t used = 0;           ///< bit per slot
  void clear() {
    records.clear();
    slots.clear();
    used = 0;
  }
};

/// What one sweep over a patch leaves behind; combined over patches in patch order.
struct PatchResult {
  double max_rate = 0;                    ///< 1/dt at CFL 1, theory 12 [1/s]
  int limiter = 0;                        ///< 0 wave, 1 flow, 2 dilatation
  int limiting_point = 0;                 ///< index in the patch; after the gather the point's id
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
  PatchLinks links;
  Outbox outbox;
  PatchResult result;

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
  bool at_boundary = false;
  bool at_wall = false;  ///< holds columns of a unilateral wall
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
  explicit BlockGrid(const GridGeometry& geometry) : geometry_{geometry} {}

  const GridGeometry& geometry() const { return geometry_; }
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
  /// Velocity field of each body; bodies beyond the list are in field 0. Before rebuild().
  void set_fields(std::vector<FieldId> field_of_body) { field_of_body_ = std::move(field_of_body); }
  int find_patch(const BlockKey& key, int body) const;            ///< -1: none
  int find_node_block(const BlockKey& key, FieldId field) const;  ///< -1: none
  /// The block of a node, and which it is there.
  std::pair<BlockKey, int> place_of_node(const std::array<int, 3>& storage_index) const;
  /// nullptr: not stored
  double* find_node(const std::array<int, 3>& storage_index, FieldId field) const;
  /// Sort patches, drop empty ones if asked, lay out node blocks and all links.
  void rebuild(bool drop_empty);

 private:
  void make_node_blocks();
  void link_patches();

  GridGeometry geometry_;
  std::vector<Patch> patches_;
  std::vector<NodeBlock> node_blocks_;
  std::vector<TileRef> tile_refs_;
  std::vector<FieldId> field_of_body_;
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

}  // namespace krater
