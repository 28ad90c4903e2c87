// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/sph/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/core/parallel.hpp"
#include "krater/points/layout.hpp"

namespace krater {

namespace {

constexpr int kChunkGroups = 32;
constexpr std::size_t kChunkItems = 2048;
constexpr int kBits = 21;  // of a key, for each axis
constexpr double kMostCells = 1e6;

using Key = std::uint64_t;

Key shift(Key key, int x, int y, int z) {
  return key +
         static_cast<Key>(static_cast<std::int64_t>(x) + (static_cast<std::int64_t>(y) << kBits) +
                          (static_cast<std::int64_t>(z) << (2 * kBits)));
}

Key axis_key(double x, double size, std::size_t item) {
  const double cell = std::floor(x / size);
  if (!(std::abs(cell) < kMostCells))
    throw NumericalError(fmt::format(
        "particle {} is at {:.3g} m: neighbours are not sought a million supports from the origin",
        item, x));
  return static_cast<Key>(static_cast<std::int64_t>(cell) + (1 << (kBits - 1)));
}

Key key_of(const double* x, double size, std::size_t item) {
  return axis_key(x[0], size, item) | axis_key(x[1], size, item) << kBits |
         axis_key(x[2], size, item) << (2 * kBits);
}

template <class Work>
void in_chunks(std::size_t count, std::size_t each, const Work& work) {
  for_each((count + each - 1) / each,
           [&](std::size_t c) { work(c, c * each, std::min((c + 1) * each, count)); });
}

}  // namespace

std::vector<std::uint32_t> order_along_curve(const std::vector<std::array<double, 3>>& places,
                                             double size) {
  const auto spread = [](Key x) {  // a bit to every third
    Key out = 0;
    for (int b = 0; b < kBits; ++b) out |= (x >> b & 1U) << (3 * b);
    return out;
  };
  std::vector<std::pair<Key, std::uint32_t>> items(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    Key key = 0;
    for (std::size_t a = 0; a < 3; ++a) key |= spread(axis_key(places[i][a], size, i)) << a;
    items[i] = {key, static_cast<std::uint32_t>(i)};
  }
  std::sort(items.begin(), items.end());
  std::vector<std::uint32_t> out(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) out[i] = items[i].second;
  return out;
}

Neighbours::Neighbours(int dimension, double support, double skin, std::vector<Plane> planes)
    : dim_{dimension},
      support_{support},
      skin_{skin},
      radius_{support + skin},
      planes_{std::move(planes)} {}

void Neighbours::make(const double* motion, int count) {
  std::vector<double> places(3 * static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    std::copy_n(motion + kMotion * i, 3, places.data() + 3 * i);
  make_from(places.data(), count);
}

void Neighbours::make_from(const double* places, int count) {
  count_ = static_cast<std::size_t>(count);
  if (places != places_.data()) places_.assign(places, places + 3 * count_);
  first_image_ = (count_ + kLanes - 1) / kLanes * kLanes;
  find_images(count);
  sort_items(count);
  const std::size_t groups = first_image_ / kLanes;
  rows_.assign(groups, {});
  storage_.resize((groups + kChunkGroups - 1) / kChunkGroups);
  for_each(storage_.size(), [&](std::size_t c) { list_groups(c, count); });
  find_pairs();
  ++made_;
}

/// How far the particle that is furthest across a plane has gone; 0: none.
double Neighbours::deepest(const Plane& plane, const double* x, std::size_t stride) const {
  double across = 0;
  for (std::size_t i = 0; i < count_; ++i) across = std::max(across, -plane.depth(x + stride * i));
  return across;
}

/// Axis after axis, all that is there by then across both planes of it, time and again.
void Neighbours::find_images(int count) {
  images_.clear();
  for (Plane& plane : planes_) plane.reach = radius_ + deepest(plane, places_.data(), 3);
  struct Item {
    Image image;
    int last;  ///< plane that it was reflected at last on this axis
  };
  std::vector<Item> items;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(dim_); ++axis) {
    if (std::none_of(planes_.begin(), planes_.end(),
                     [axis](const Plane& p) { return p.axis == axis; }))
      continue;
    items.clear();
    for (std::int32_t i = 0; i < count; ++i) items.push_back({{i, {1, 1, 1}, {0, 0, 0}}, -1});
    for (const Image& image : images_) items.push_back({image, -1});
    for (std::size_t k = 0; k < items.size(); ++k)
      for (std::size_t p = 0; p < planes_.size(); ++p) {
        const Plane& plane = planes_[p];
        if (plane.axis != axis || items[k].last == static_cast<int>(p)) continue;
        const Image& from = items[k].image;
        const double x = from.sign[axis] * places_[3 * static_cast<std::size_t>(from.of) + axis] +
                         from.offset[axis];
        if (!(plane.inwards * (x - plane.at) < plane.reach)) continue;
        Image image = from;
        image.sign[axis] = -from.sign[axis];
        image.offset[axis] = 2 * plane.at - from.offset[axis];
        items.push_back({image, static_cast<int>(p)});
        images_.push_back(image);
      }
  }
}

std::array<double, 3> Neighbours::place_of(std::uint32_t item) const {
  std::array<double, 3> x;
  if (item < count_) {
    std::copy_n(places_.data() + 3 * item, 3, x.data());
    return x;
  }
  const Image& image = images_[item - first_image_];
  for (std::size_t a = 0; a < 3; ++a)
    x[a] = image.sign[a] * places_[3 * static_cast<std::size_t>(image.of) + a] + image.offset[a];
  return x;
}

void Neighbours::sort_items(int count) {
  const std::size_t all = count_ + images_.size();
  std::vector<std::pair<Key, std::uint32_t>> items(all);
  in_chunks(all, kChunkItems, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const auto item = static_cast<std::uint32_t>(k < count_ ? k : k - count_ + first_image_);
      items[k] = {key_of(place_of(item).data(), radius_, k), item};
    }
  });
  std::sort(items.begin(), items.end());
  order_.resize(all);
  sorted_.resize(3 * all);
  cell_of_.resize(static_cast<std::size_t>(count));
  cells_.clear();
  for (std::size_t k = 0; k < all; ++k) {
    const auto at = static_cast<std::uint32_t>(k);
    if (cells_.empty() || cells_.back().key != items[k].first)
      cells_.push_back({items[k].first, at, at});
    cells_.back().last = at + 1;
    order_[k] = items[k].second;
    if (items[k].second < count_)
      cell_of_[items[k].second] = static_cast<std::uint32_t>(cells_.size() - 1);
    const std::array<double, 3> x = place_of(items[k].second);
    std::copy_n(x.data(), 3, sorted_.data() + 3 * k);
  }
}

/// Ranges of sorted items in the rows of cells about a cell.
Neighbours::Ranges Neighbours::near_ranges(const Cell& cell) const {
  Ranges out{};
  std::size_t n = 0;
  const auto by_key = [](const Cell& c, Key key) { return c.key < key; };
  for (int z = dim_ == 3 ? -1 : 0; z <= (dim_ == 3 ? 1 : 0); ++z)
    for (int y = -1; y <= 1; ++y) {
      const auto first = std::lower_bound(cells_.begin(), cells_.end(), shift(cell.key, -1, y, z),
                                          by_key),
                 last = std::lower_bound(first, cells_.end(), shift(cell.key, 2, y, z), by_key);
      if (first != last) out[n++] = {first->first, (last - 1)->last};
    }
  return out;
}

/// Into `out` what is within the radius of particle i, of some ranges of sorted items; how many.
/// Every item is written, and counted if it is near: of six that are looked at one is, in no order
/// that a processor could foretell.
std::size_t Neighbours::list_near(int i, const Ranges& ranges,
                                  std::vector<std::int32_t>& out) const {
  const double most = radius_ * radius_;
  const double* x = places_.data() + 3 * static_cast<std::size_t>(i);
  std::size_t all = 0, count = 0;
  for (const auto& [from, end] : ranges) all += end - from;
  if (out.size() < all + 1) out.resize(all + 1);
  for (const auto& [from, end] : ranges)
    for (std::uint32_t k = from; k < end; ++k) {
      const double* y = sorted_.data() + 3 * static_cast<std::size_t>(k);
      const double a = x[0] - y[0], b = x[1] - y[1], c = x[2] - y[2];
      const auto item = static_cast<std::int32_t>(order_[k]);
      out[count] = item;
      count += static_cast<std::size_t>(a * a + b * b + c * c < most) &
               static_cast<std::size_t>(item != i);
    }
  return count;
}

void Neighbours::list_groups(std::size_t chunk, int count) {
  std::vector<std::int32_t>& to = storage_[chunk];
  const int groups = (count + kLanes - 1) / kLanes, first = static_cast<int>(chunk) * kChunkGroups,
            last = std::min(first + kChunkGroups, groups);
  std::array<std::vector<std::int32_t>, kLanes> lanes;  // of which `near[lane]` count
  std::array<std::size_t, kLanes> near{};
  std::vector<std::size_t> starts;
  std::uint32_t cell = static_cast<std::uint32_t>(-1);
  Ranges ranges{};
  to.clear();
  for (int g = first; g < last; ++g) {
    std::size_t rows = 0;
    for (std::size_t l = 0; l < kLanes; ++l) {
      near[l] = 0;
      const int i = kLanes * g + static_cast<int>(l);
      if (i >= count) continue;
      if (cell_of_[static_cast<std::size_t>(i)] != cell) {
        cell = cell_of_[static_cast<std::size_t>(i)];
        ranges = near_ranges(cells_[cell]);
      }
      near[l] = list_near(i, ranges, lanes[l]);
      rows = std::max(rows, near[l]);
    }
    std::size_t at = to.size();
    starts.push_back(at);
    rows_[static_cast<std::size_t>(g)].count = static_cast<int>(rows);
    to.resize(at + rows * kLanes);
    for (std::size_t k = 0; k < rows; ++k)
      for (std::size_t l = 0; l < kLanes; ++l)
        to[at++] = k < near[l] ? lanes[l][k] : kLanes * g + static_cast<int>(l);
  }
  for (int g = first; g < last; ++g)
    rows_[static_cast<std::size_t>(g)].rows =
        to.data() + starts[static_cast<std::size_t>(g - first)];
}

/// Pairs of cells with none or one between them, and every cell with itself.
void Neighbours::find_pairs() {
  pairs_.clear();
  const auto by_key = [](const Cell& c, Key key) { return c.key < key; };
  const int deep = dim_ == 3 ? 2 : 0;
  for (std::uint32_t n = 0; n < cells_.size(); ++n)
    for (int z = 0; z <= deep; ++z)
      for (int y = z > 0 ? -2 : 0; y <= 2; ++y) {
        const int from = z > 0 || y > 0 ? -2 : 0;
        const Key key = cells_[n].key;
        auto at =
            std::lower_bound(cells_.begin() + n, cells_.end(), shift(key, from, y, z), by_key);
        for (; at != cells_.end() && at->key <= shift(key, 2, y, z); ++at) {
          const auto x = static_cast<std::int64_t>(at->key - shift(key, 0, y, z));
          pairs_.push_back({n,
                            static_cast<std::uint32_t>(at - cells_.begin()),
                            {static_cast<std::int8_t>(x), static_cast<std::int8_t>(y),
                             static_cast<std::int8_t>(z)}});
        }
      }
}

std::vector<Neighbours::Reach> Neighbours::reaches(const double* motion) const {
  std::vector<Reach> out(cells_.size());
  in_chunks(cells_.size(), 64, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      Reach& reach = out[n];
      reach.low.fill(INFINITY);
      reach.high.fill(-INFINITY);
      for (std::uint32_t k = cells_[n].first; k < cells_[n].last; ++k) {
        const std::uint32_t item = order_[k];
        const Image* image = item < count_ ? nullptr : &images_[item - first_image_];
        const auto of = static_cast<std::size_t>(image ? image->of : static_cast<int>(item));
        for (std::size_t a = 0; a < 3; ++a) {
          double u = motion[kMotion * of + a] - places_[3 * of + a];
          if (image) u *= image->sign[a];
          reach.low[a] = std::min(reach.low[a], u);
          reach.high[a] = std::max(reach.high[a], u);
        }
      }
    }
  });
  return out;
}

bool Neighbours::may_meet(const CellPair& pair, const std::vector<Reach>& reach) const {
  const Reach &low = reach[pair.low], &high = reach[pair.high];
  double squares = 0;
  bool beside = true;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) {
    const double closing = low.high[a] - high.low[a], opening = high.high[a] - low.low[a];
    if (std::abs(pair.apart[a]) == 2) {
      beside = false;
      if (!((pair.apart[a] > 0 ? closing : opening) > skin_)) return false;
    }
    const double most = std::max(std::abs(closing), std::abs(opening));
    squares += most * most;
  }
  return !beside || squares > skin_ * skin_;
}

bool Neighbours::stale(const double* motion) const {
  for (const Plane& plane : planes_) {  // what had no image and may need one
    const double across = deepest(plane, motion, kMotion);
    for (std::size_t i = 0; i < count_; ++i)
      if (plane.depth(motion + kMotion * i) < support_ + across &&
          !(plane.depth(places_.data() + 3 * i) < plane.reach))
        return true;
  }
  const std::vector<Reach> reach = reaches(motion);
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a) {
    double low = INFINITY, high = -INFINITY;
    for (const Reach& r : reach) {
      low = std::min(low, r.low[a]);
      high = std::max(high, r.high[a]);
    }
    if (high - low > skin_ + radius_) return true;
  }
  std::vector<std::uint8_t> stale((pairs_.size() + kChunkItems - 1) / kChunkItems, 0);
  in_chunks(pairs_.size(), kChunkItems, [&](std::size_t c, std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last && stale[c] == 0; ++k)
      if (may_meet(pairs_[k], reach)) stale[c] = 1;
  });
  return std::any_of(stale.begin(), stale.end(), [](std::uint8_t s) { return s != 0; });
}

void Neighbours::reflect_motion(double* motion) const {
  in_chunks(images_.size(), kChunkItems, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t m = first; m < last; ++m) {
      const Image& image = images_[m];
      const double* from = motion + kMotion * static_cast<std::size_t>(image.of);
      double* to = motion + kMotion * (first_image_ + m);
      for (std::size_t a = 0; a < 3; ++a) {
        to[a] = image.sign[a] * from[a] + image.offset[a];
        to[4 + a] = image.sign[a] * from[4 + a];
      }
      to[3] = from[3];
    }
  });
}

void Neighbours::reflect_load(double* load) const {
  constexpr std::size_t kAxes = 3;
  const LoadRecord at = load_record(dim_);
  in_chunks(images_.size(), kChunkItems, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t m = first; m < last; ++m) {
      const Image& image = images_[m];
      const double* from = load + at.size * image.of;
      double* to = load + static_cast<std::size_t>(at.size) * (first_image_ + m);
      const auto place = [&](int slot, std::size_t a) {
        to[slot] = image.sign[a] * from[slot] + image.offset[a];
      };
      for (std::size_t a = 0; a < kAxes; ++a) place(static_cast<int>(a), a);
      to[3] = from[3];
      to[at.Z] = from[at.Z];
      for (int a = 0; a < dim_; ++a) {
        const auto sign = [&image](int axis) { return image.sign[static_cast<std::size_t>(axis)]; };
        place(at.now + a, static_cast<std::size_t>(a));
        to[at.v + a] = sign(a) * from[at.v + a];
        for (int b = 0; b < dim_; ++b)
          to[at.A + dim_ * a + b] = sign(a) * sign(b) * from[at.A + dim_ * a + b];
        for (int b = 0; b <= a; ++b) {
          const int D = at.D + (a == b ? a : dim_ == 3 ? 6 - a - b : 2);
          to[D] = sign(a) * sign(b) * from[D];
        }
      }
    }
  });
}

double Neighbours::mean_count() const {
  double listed = 0;
  for (std::size_t g = 0; g < rows_.size(); ++g)
    for (int k = 0; k < kLanes * rows_[g].count; ++k)
      listed += rows_[g].rows[k] != static_cast<std::int32_t>(kLanes * g) + k % kLanes ? 1 : 0;
  return count_ > 0 ? listed / static_cast<double>(count_) : 0;
}

std::size_t Neighbours::memory() const {
  std::size_t bytes = 8 * (places_.size() + sorted_.size()) + sizeof(Image) * images_.size() +
                      sizeof(Cell) * cells_.size() + sizeof(CellPair) * pairs_.size() +
                      sizeof(NeighbourRows) * rows_.size() + 4 * (order_.size() + cell_of_.size());
  for (const auto& chunk : storage_) bytes += 4 * chunk.capacity();
  return bytes;
}

}  // namespace krater
