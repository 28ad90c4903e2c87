// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/grid/neighbourhood.hpp"

#include <algorithm>

namespace krater {

namespace {

BlockKey ancestor(BlockKey key, int level, int dimension) {
  while (key.level > level) key = parent_of(key, dimension);
  return key;
}

int level_above(int level) { return std::max(0, level - 1); }

bool has(const std::vector<BlockKey>& sorted, const BlockKey& key) {
  return std::binary_search(sorted.begin(), sorted.end(), key);
}

}  // namespace

std::vector<BlockKey> keys_within(std::vector<BlockKey> keys, int width, int dimension) {
  const auto tidy = [&keys] {
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  };
  tidy();
  for (int a = 0; a < dimension; ++a) {
    const std::size_t before = keys.size();
    for (std::size_t k = 0; k < before; ++k)
      for (int offset = -width; offset <= width; ++offset) {
        if (offset == 0) continue;
        BlockKey key = keys[k];
        key.i[static_cast<std::size_t>(a)] += offset;
        keys.push_back(key);
      }
    tidy();
  }
  return keys;
}

Neighbourhood::Neighbourhood(const std::vector<BlockKey>& blocks, int width, int dimension)
    : dimension_{dimension} {
  int finest = 0;
  for (const BlockKey& key : blocks) finest = std::max(finest, key.level);
  for (int level = 0; level <= finest; ++level) {
    std::vector<BlockKey> all, own;
    for (const BlockKey& key : blocks) {
      if (key.level < level) continue;
      all.push_back(ancestor(key, level_above(level), dimension));
      if (key.level == level) own.push_back(all.back());
    }
    to_own_level_.push_back(keys_within(std::move(all), width, dimension));
    to_finer_.push_back(finest == level ? to_own_level_.back()
                                        : keys_within(std::move(own), width, dimension));
  }
}

bool Neighbourhood::holds(const BlockKey& key) const {
  for (std::size_t level = 0; level < to_own_level_.size(); ++level) {
    const int l = static_cast<int>(level);
    if (l > key.level) break;
    const auto& near = l == key.level ? to_own_level_[level] : to_finer_[level];
    if (has(near, ancestor(key, level_above(l), dimension_))) return true;
  }
  return false;
}

}  // namespace krater
