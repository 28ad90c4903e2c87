// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file grid/key_index.hpp
/// From (block key, tag) to an index in constant time: open addressing, at most half full. A search
/// in the sorted blocks costs a dozen cache misses; every change of the topology asks 35 times per
/// patch.
#include <array>
#include <compare>
#include <cstdint>
#include <vector>

namespace krater {

/// A block of nodes and cells: where it lies among those of its level (grid/levels.hpp).
struct BlockKey {
  std::array<std::int32_t, 3> i{};
  std::int32_t level = 0;
  friend constexpr bool operator==(const BlockKey& a, const BlockKey& b) {
    return a.i[0] == b.i[0] && a.i[1] == b.i[1] && a.i[2] == b.i[2] && a.level == b.level;
  }
  friend constexpr std::strong_ordering operator<=>(const BlockKey& a, const BlockKey& b) {
    if (a.level != b.level) return a.level <=> b.level;
    for (std::size_t k = 0; k < 2; ++k)
      if (a.i[k] != b.i[k]) return a.i[k] <=> b.i[k];
    return a.i[2] <=> b.i[2];
  }
};

inline std::size_t hash_of(const BlockKey& key, int tag) {
  std::uint64_t hash =
      static_cast<std::uint32_t>(tag) ^ (static_cast<std::uint64_t>(key.level) << 32U);
  for (const std::int32_t i : key.i) {
    hash = (hash ^ static_cast<std::uint32_t>(i)) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

class KeyIndex {
 public:
  /// Empty, with room for `count` entries.
  void clear(std::size_t count) {
    std::size_t size = 16;
    while (size < 2 * count) size *= 2;
    slots_.assign(size, Slot{{}, 0, -1});
    count_ = 0;
  }
  void insert(const BlockKey& key, int tag, int index) {
    if (2 * ++count_ > slots_.size()) grow();
    std::size_t at = start(key, tag);
    while (slots_[at].index >= 0) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = {key, tag, index};
  }
  /// -1: not there.
  int find(const BlockKey& key, int tag) const {
    if (slots_.empty()) return -1;
    for (std::size_t at = start(key, tag);; at = (at + 1) & (slots_.size() - 1)) {
      const Slot& slot = slots_[at];
      if (slot.index < 0 || (slot.tag == tag && slot.key == key)) return slot.index;
    }
  }

 private:
  void grow() {
    std::vector<Slot> old;
    old.swap(slots_);
    clear(old.size());
    for (const Slot& slot : old)
      if (slot.index >= 0) insert(slot.key, slot.tag, slot.index);
    ++count_;  // the one that asked for room
  }
  struct Slot {
    BlockKey key;
    int tag, index;
  };
  std::size_t start(const BlockKey& key, int tag) const {
    return hash_of(key, tag) & (slots_.size() - 1);
  }
  std::vector<Slot> slots_;
  std::size_t count_ = 0;
};

}  // namespace krater
