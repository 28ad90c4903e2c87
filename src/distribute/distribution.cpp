// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/distribute/distribution.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "krater/core/ranks.hpp"
#include "krater/grid/neighbourhood.hpp"

namespace krater {

namespace {

constexpr double kUneven = 1.05;    ///< most over mean from which blocks are dealt out anew
constexpr int kSettlingSteps = 50;  ///< and not before so many steps
constexpr int kRestlessSteps = 5;

template <class T>
void put(std::vector<std::byte>& to, const T& what) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t at = to.size();
  to.resize(at + sizeof(T));
  std::memcpy(to.data() + at, &what, sizeof(T));
}

/// Reads back in the order of writing.
class Reader {
 public:
  explicit Reader(const std::vector<std::byte>& from) : at_{from.data()} {}
  template <class T>
  T take() {
    T what;
    std::memcpy(&what, at_, sizeof(T));
    at_ += sizeof(T);
    return what;
  }

 private:
  const std::byte* at_;
};

/// What all ranks know of a patch after a sweep.
struct Found {
  PatchResult result;
  double cost;
  std::int32_t count;
  std::uint32_t used;
  bool steady, takes_out;
};

bool takes_out(const Removed& r) { return r.count > 0 || r.reflections > 0 || r.failed > 0; }

/// work(patch, reader) for the patches of all other ranks, in their order.
template <class Work>
void read_others(BlockGrid& grid, const std::vector<std::vector<std::byte>>& all,
                 const Work& work) {
  std::vector<Reader> readers;
  for (const std::vector<std::byte>& one : all) readers.emplace_back(one);
  for (std::size_t p = 0; p < grid.patches().size(); ++p)
    if (Patch& patch = grid.patches()[p]; !patch.here)
      work(p, patch, readers[static_cast<std::size_t>(patch.rank)]);
}

double expected_cost(double points) { return 1e-7 * points + 1e-6; }  ///< before it is known [s]

double weight_of(const Patch& patch) {
  return patch.cost > 0 ? patch.cost : expected_cost(patch.count());
}

}  // namespace

void Distribution::deal(BlockGrid& grid, const std::map<BlockKey, double>& points) {
  std::vector<Partition::Weighted> blocks;
  for (const auto& [key, count] : points) blocks.push_back({key, expected_cost(count)});
  partition_.cut(blocks);
  steps_since_cut_ = 0;
  grid.set_owners([this](const BlockKey& key) { return partition_.owner(key); }, ranks::index(),
                  width_);
}

double Distribution::imbalance(const BlockGrid& grid) const {
  std::vector<double> load(static_cast<std::size_t>(ranks::count()));
  double all = 0;
  for (const Patch& patch : grid.patches()) {
    load[static_cast<std::size_t>(patch.rank)] += weight_of(patch);
    all += weight_of(patch);
  }
  const double most = *std::max_element(load.begin(), load.end());
  return all > 0 ? most * static_cast<double>(load.size()) / all : 1;
}

bool Distribution::rebalance(BlockGrid& grid) {
  ++steps_since_cut_;
  if (partition_.restless() ? steps_since_cut_ < kRestlessSteps
                            : steps_since_cut_ < kSettlingSteps || imbalance(grid) < kUneven)
    return false;
  steps_since_cut_ = 0;
  std::vector<Partition::Weighted> blocks;
  for (const Patch& patch : grid.patches()) blocks.push_back({patch.key, weight_of(patch)});
  partition_.cut(blocks);
  const auto count = static_cast<std::size_t>(ranks::count());
  std::vector<ranks::Message> out(count);
  std::vector<bool> from(count);
  std::vector<std::pair<std::size_t, int>> moved;  // patch, and whose it was
  for (std::size_t p = 0; p < grid.patches().size(); ++p) {
    Patch& patch = grid.patches()[p];
    const int to = partition_.owner(patch.key);
    if (to == patch.rank) continue;
    moved.emplace_back(p, patch.rank);
    if (patch.here) {
      patch.held = patch.points.count();
      for (int i = 0; i < patch.held; ++i)
        patch.points.copy_out(i, out[static_cast<std::size_t>(to)].data);
      patch.points = PointStore{patch.points.stride()};
    } else if (to == ranks::index()) {
      from[static_cast<std::size_t>(patch.rank)] = true;
    }
    patch.rank = to;
  }
  if (moved.empty()) return false;
  ++cuts_;
  std::vector<ranks::Message> sent;
  std::vector<int> sources;
  for (std::size_t r = 0; r < count; ++r) {
    if (from[r]) sources.push_back(static_cast<int>(r));
    const bool any = std::any_of(moved.begin(), moved.end(), [&](const auto& m) {
      return m.second == ranks::index() && grid.patches()[m.first].rank == static_cast<int>(r);
    });
    if (any) sent.push_back({static_cast<int>(r), std::move(out[r].data)});
  }
  const std::vector<ranks::Message> in = ranks::exchange(sent, sources);
  std::vector<const double*> at(count);
  for (const ranks::Message& m : in) at[static_cast<std::size_t>(m.rank)] = m.data.data();
  for (const auto& [p, before] : moved) {
    Patch& patch = grid.patches()[p];
    if (patch.rank != ranks::index()) continue;
    const double*& record = at[static_cast<std::size_t>(before)];
    for (int i = 0; i < patch.held; ++i, record += patch.points.stride() / kLanes)
      patch.points.append(record);
    if (patch.held > 0) patch.points.pad(columns_[static_cast<std::size_t>(patch.body)].mass);
    patch.touch();
  }
  grid.rebuild(false);
  return true;
}

Distribution::Neighbour& Distribution::neighbour(int rank) {
  auto at = std::lower_bound(neighbours_.begin(), neighbours_.end(), rank,
                             [](const Neighbour& n, int r) { return n.rank < r; });
  if (at == neighbours_.end() || at->rank != rank) at = neighbours_.insert(at, {rank, {}, {}});
  return *at;
}

// Near is mutual: a patch of mine is near one of yours as yours is near mine. So both sides list
// the same patches, in the order of all, and no list is sent.
void Distribution::relink(const BlockGrid& grid) {
  neighbours_.clear();
  for (std::size_t p = 0; p < grid.patches().size(); ++p)
    if (const Patch& patch = grid.patches()[p]; patch.near && !patch.here)
      neighbour(patch.rank).receive.push_back(static_cast<int>(p));
  decltype(known_) still;
  for (Neighbour& n : neighbours_) {
    std::vector<BlockKey> keys;
    for (const int p : n.receive) keys.push_back(grid.patches()[static_cast<std::size_t>(p)].key);
    const Neighbourhood theirs{keys, width_, grid.geometry().dimension};
    for (std::size_t p = 0; p < grid.patches().size(); ++p) {
      const Patch& patch = grid.patches()[p];
      if (!patch.here || !theirs.holds(patch.key)) continue;
      n.send.push_back(static_cast<int>(p));
      const std::pair name{std::pair{n.rank, patch.body}, patch.key};
      if (known_.count(name) > 0) still.insert(name);
    }
  }
  known_ = std::move(still);
  sent_.resize(neighbours_.size());
  received_.resize(neighbours_.size());
  goes_out_.assign(grid.patches().size(), 0);
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    sent_[n].rank = received_[n].rank = neighbours_[n].rank;
    for (const int p : neighbours_[n].send) goes_out_[static_cast<std::size_t>(p)] = 1;
  }
}

void Distribution::send_tiles(BlockGrid& grid) {
  const auto size = static_cast<std::size_t>(tile_nodes(grid.geometry().dimension)) * kNodeDoubles;
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    std::vector<double>& data = sent_[n].data;
    data.clear();
    for (const int p : neighbours_[n].send) {
      const Patch& patch = grid.patches()[static_cast<std::size_t>(p)];
      const bool asleep = patch.tile.state == Tile::State::asleep;
      const bool is_new = known_.insert({{neighbours_[n].rank, patch.body}, patch.key}).second;
      data.push_back(asleep ? 1 : 0);
      data.push_back(asleep && !is_new ? 0 : 1);
      if (!asleep || is_new) data.insert(data.end(), patch.tile.data(), patch.tile.data() + size);
    }
  }
  ranks::send(sent_);
}

void Distribution::receive_tiles(BlockGrid& grid) {
  const auto size = static_cast<std::size_t>(tile_nodes(grid.geometry().dimension)) * kNodeDoubles;
  ranks::receive(received_);
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    const double* at = received_[n].data.data();
    for (const int p : neighbours_[n].receive) {
      Patch& patch = grid.patches()[static_cast<std::size_t>(p)];
      patch.tile.state = *at++ > 0 ? Tile::State::asleep : Tile::State::ahead;
      if (!(*at++ > 0)) continue;
      std::copy_n(at, size, patch.tile.data());
      at += size;
    }
  }
}

void Distribution::share_results(BlockGrid& grid, std::vector<Removed>& removed) const {
  std::vector<std::byte> own;
  for (std::size_t p = 0; p < grid.patches().size(); ++p) {
    const Patch& patch = grid.patches()[p];
    if (!patch.here) continue;
    put(own, Found{patch.result, patch.cost, patch.points.count(), patch.outbox.used, patch.steady,
                   takes_out(removed[p])});
    if (takes_out(removed[p])) put(own, removed[p]);
  }
  read_others(grid, ranks::all_gather(own), [&](std::size_t p, Patch& patch, Reader& from) {
    const auto found = from.take<Found>();
    patch.result = found.result;
    patch.cost = found.cost;
    patch.held = found.count;
    patch.outbox.used = found.used;
    patch.steady = found.steady;
    removed[p] = found.takes_out ? from.take<Removed>() : Removed{};
  });
}

void Distribution::share_bytes(const BlockGrid& grid, std::size_t size,
                               std::span<std::byte> found) const {
  std::vector<std::byte> own;
  for (std::size_t p = 0; p < grid.patches().size(); ++p)
    if (grid.patches()[p].here) {
      const auto piece = found.subspan(p * size, size);
      own.insert(own.end(), piece.begin(), piece.end());
    }
  std::vector<int> sizes(static_cast<std::size_t>(ranks::count()));
  for (const Patch& patch : grid.patches())
    sizes[static_cast<std::size_t>(patch.rank)] += static_cast<int>(size);
  const std::vector<std::byte> all = ranks::all_gather(own, sizes);
  std::vector<std::size_t> at(sizes.size());
  for (std::size_t r = 1; r < at.size(); ++r)
    at[r] = at[r - 1] + static_cast<std::size_t>(sizes[r - 1]);
  for (std::size_t p = 0; p < grid.patches().size(); ++p) {
    const auto r = static_cast<std::size_t>(grid.patches()[p].rank);
    if (!grid.patches()[p].here) std::memcpy(found.data() + p * size, all.data() + at[r], size);
    at[r] += size;
  }
}

void Distribution::share_keys(const BlockGrid& grid,
                              std::vector<std::vector<BlockKey>>& found) const {
  std::vector<std::byte> own;
  for (std::size_t p = 0; p < found.size(); ++p) {
    if (!grid.patches()[p].here) continue;
    put(own, found[p].size());
    for (const BlockKey& key : found[p]) put(own, key);
  }
  const auto all = ranks::all_gather(own);
  std::vector<Reader> readers;
  for (const auto& one : all) readers.emplace_back(one);
  for (std::size_t p = 0; p < found.size(); ++p) {
    if (grid.patches()[p].here) continue;
    Reader& from = readers[static_cast<std::size_t>(grid.patches()[p].rank)];
    found[p].resize(from.take<std::size_t>());
    for (BlockKey& key : found[p]) key = from.take<BlockKey>();
  }
}

void Distribution::send_points(BlockGrid& grid) const {
  const int slots = neighbour_count(grid.geometry().dimension);
  std::vector<ranks::Message> out(static_cast<std::size_t>(ranks::count()));
  std::vector<bool> from(out.size());
  const auto rank_of = [&grid](const Patch& patch, int slot) {
    return grid
        .patches()[static_cast<std::size_t>(patch.links.neighbours[static_cast<std::size_t>(slot)])]
        .rank;
  };
  for (std::size_t p = 0; p < grid.patches().size(); ++p) {
    const Patch& patch = grid.patches()[p];
    for (int s = 0; s < slots; ++s) {
      if ((patch.outbox.used >> s & 1U) == 0) continue;
      const int to = rank_of(patch, s);
      if (!patch.here) {
        if (to == ranks::index()) from[static_cast<std::size_t>(patch.rank)] = true;
        continue;
      }
      if (to == ranks::index()) continue;
      const auto width = static_cast<std::ptrdiff_t>(patch.points.stride() / kLanes);
      std::vector<double>& data = out[static_cast<std::size_t>(to)].data;
      for (std::size_t k = 0; k < patch.outbox.slots.size(); ++k) {
        if (patch.outbox.slots[k] != s) continue;
        const auto record = patch.outbox.records.begin() + static_cast<std::ptrdiff_t>(k) * width;
        data.push_back(static_cast<double>(p));
        data.push_back(s);
        data.insert(data.end(), record, record + width);
      }
    }
  }
  std::vector<ranks::Message> sent;
  std::vector<int> sources;
  for (std::size_t r = 0; r < out.size(); ++r) {
    if (!out[r].data.empty()) sent.push_back({static_cast<int>(r), std::move(out[r].data)});
    if (from[r]) sources.push_back(static_cast<int>(r));
  }
  for (const ranks::Message& message : ranks::exchange(sent, sources))
    for (auto at = message.data.begin(); at != message.data.end();) {
      Patch& patch = grid.patches()[static_cast<std::size_t>(*at++)];
      patch.outbox.slots.push_back(static_cast<std::uint8_t>(*at++));
      const auto end = at + static_cast<std::ptrdiff_t>(patch.points.stride() / kLanes);
      patch.outbox.records.insert(patch.outbox.records.end(), at, end);
      at = end;
    }
}

void Distribution::share_counts(BlockGrid& grid) const {
  std::vector<int> counts;
  for (const Patch& patch : grid.patches()) counts.push_back(patch.points.count());
  share(grid, counts);
  for (std::size_t p = 0; p < counts.size(); ++p) grid.patches()[p].held = counts[p];
}

std::vector<ranks::Message> Distribution::exchange_any(std::vector<std::vector<double>> by_rank) {
  std::vector<std::byte> sends(by_rank.size());
  std::vector<ranks::Message> out;
  for (std::size_t r = 0; r < by_rank.size(); ++r) {
    sends[r] = by_rank[r].empty() ? std::byte{0} : std::byte{1};
    if (!by_rank[r].empty()) out.push_back({static_cast<int>(r), std::move(by_rank[r])});
  }
  const auto all = ranks::all_gather(sends);
  std::vector<int> from;
  for (std::size_t r = 0; r < all.size(); ++r)
    if (all[r][static_cast<std::size_t>(ranks::index())] != std::byte{0})
      from.push_back(static_cast<int>(r));
  return ranks::exchange(out, from);
}

void Distribution::assemble(BlockGrid& grid) const {
  std::vector<ranks::Message> out;
  std::vector<int> from;
  if (ranks::first()) {
    for (int r = 1; r < ranks::count(); ++r) from.push_back(r);
  } else {
    ranks::Message& message = out.emplace_back();
    for (const Patch& patch : grid.patches())
      if (patch.here)
        for (int i = 0; i < patch.points.count(); ++i) patch.points.copy_out(i, message.data);
  }
  std::vector<ranks::Message> in = ranks::exchange(out, from);
  std::vector<const double*> at(in.size() + 1);
  for (const ranks::Message& m : in) at[static_cast<std::size_t>(m.rank)] = m.data.data();
  if (!ranks::first()) return;
  for (Patch& patch : grid.patches()) {
    if (patch.here || patch.held == 0) continue;
    const double*& record = at[static_cast<std::size_t>(patch.rank)];
    for (int i = 0; i < patch.held; ++i, record += patch.points.stride() / kLanes)
      patch.points.append(record);
    patch.points.pad(columns_[static_cast<std::size_t>(patch.body)].mass);
  }
}

void Distribution::release(BlockGrid& grid) const {
  for (Patch& patch : grid.patches())
    if (!patch.here) patch.points = PointStore{patch.points.stride()};
}

}  // namespace krater
