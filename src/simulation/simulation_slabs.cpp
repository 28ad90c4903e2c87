// SPDX-License-Identifier: GPL-3.0-or-later
// What several ranks hold, written by the first of them without holding it: columns of a
// checkpoint, slabs of a frame.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "krater/core/ranks.hpp"
#include "simulation/orders.hpp"
#include "simulation/slabs.hpp"

namespace krater {

/// One component of all points of a body, in the order of their sets.
void Simulation::copy_column(int body, int slot, double* to) const {
  if (!has_all_points()) {
    tell(Order::column, body, slot);
    column_together(body, slot, to);
    return;
  }
  for (const int s : sets_of(body)) {
    const PointStore& from = *set(s).points;
    for (int i = 0; i < from.count(); ++i) *to++ = from.at(kLanes * slot, i);
  }
}

void Simulation::column_together(int body, int slot, double* to) const {
  const std::vector<int> sets = sets_of(body);
  const std::vector<ranks::Message> in = to_first([&] {
    std::vector<double> own;
    for (const int s : sets) {
      const PointStore& points = *set(s).points;
      for (int i = 0; i < points.count(); ++i) own.push_back(points.at(kLanes * slot, i));
    }
    return own;
  });
  if (!ranks::first()) return;
  std::vector<const double*> at(static_cast<std::size_t>(ranks::count()));
  for (const ranks::Message& m : in) at[static_cast<std::size_t>(m.rank)] = m.data.data();
  for (const int s : sets) {
    const Patch& patch = grid_.patches()[static_cast<std::size_t>(s - first_points())];
    const double*& theirs = at[static_cast<std::size_t>(patch.rank)];
    for (int i = 0; i < patch.count(); ++i)
      *to++ = patch.here ? patch.points.at(kLanes * slot, i) : *theirs++;
  }
}

void Simulation::open_slabs_together(int body) const {
  slabs_ = std::make_unique<Slabs>();
  slabs_->body = body;
  const int id = bodies_[static_cast<std::size_t>(body)]->slot(field::Id::info);
  for (const int s : sets_of(body))
    for (int i = 0; i < set(s).count(); ++i) slabs_->own.push_back({value(s, i, id), {s, i}});
  std::sort(slabs_->own.begin(), slabs_->own.end());
  const double last = ranks::max(slabs_->own.empty() ? 0 : slabs_->own.back().first);
  std::vector<int> counts(static_cast<std::size_t>(last / Slabs::kShelf) + 1);
  for (const auto& point : slabs_->own)
    ++counts[static_cast<std::size_t>(point.first / Slabs::kShelf)];
  const auto all = ranks::all_gather(std::as_bytes(std::span{counts}));
  slabs_->starts.assign(counts.size() + 1, 0);
  std::vector<int> theirs(counts.size());
  for (const auto& bytes : all) {
    std::memcpy(theirs.data(), bytes.data(), bytes.size());
    for (std::size_t k = 0; k < theirs.size(); ++k)
      slabs_->starts[k + 1] += static_cast<std::size_t>(theirs[k]);
  }
  for (std::size_t k = 0; k < counts.size(); ++k) slabs_->starts[k + 1] += slabs_->starts[k];
}

/// Of the points of this rank on some shelves: level and record, in the order of their ids.
std::vector<double> Simulation::records_of_slab(std::size_t first, std::size_t end) const {
  std::vector<double> out;
  const auto before = [](const auto& point, double id) { return point.first < id; };
  const auto from = std::lower_bound(slabs_->own.begin(), slabs_->own.end(),
                                     static_cast<double>(first) * Slabs::kShelf, before);
  const auto to =
      std::lower_bound(from, slabs_->own.end(), static_cast<double>(end) * Slabs::kShelf, before);
  for (auto point = from; point != to; ++point) {
    const auto [s, i] = point->second;
    out.push_back(geometry_of(s).level);
    set(s).points->copy_out(i, out);
  }
  return out;
}

void Simulation::slab_together(std::size_t first, std::size_t end) const {
  std::vector<ranks::Message> in = to_first([&] { return records_of_slab(first, end); });
  if (!ranks::first()) return;
  in.push_back({0, records_of_slab(first, end)});
  const Body& body = *bodies_[static_cast<std::size_t>(slabs_->body)];
  const auto width = static_cast<std::size_t>(body.layout().stride() / kLanes) + 1;
  const auto id = static_cast<std::size_t>(body.slot(field::Id::info)) + 1;
  std::vector<const double*> points;
  for (const ranks::Message& m : in)
    for (std::size_t k = 0; k < m.data.size(); k += width) points.push_back(m.data.data() + k);
  std::sort(points.begin(), points.end(),
            [id](const double* a, const double* b) { return a[id] < b[id]; });
  slabs_->brought = PointStore{body.layout().stride()};
  slabs_->levels.clear();
  for (const double* p : points) {
    slabs_->levels.push_back(static_cast<int>(p[0]));
    slabs_->brought.append(p + 1);
  }
  slabs_->first = slabs_->starts[first];
}

BroughtPoints Simulation::bring(int body, std::size_t first, std::size_t count) const {
  if (first == 0) {  // a frame begins
    tell(Order::open_slabs, body);
    open_slabs_together(body);
  }
  const auto& starts = slabs_->starts;  // rises; the first shelf that ends beyond a row holds it
  const auto shelf = [&starts](std::size_t row) {
    return static_cast<std::size_t>(std::upper_bound(starts.begin() + 1, starts.end(), row) -
                                    starts.begin()) -
           1;
  };
  const std::size_t from = shelf(first), end = shelf(first + count - 1) + 1;
  tell(Order::slab, static_cast<double>(from), static_cast<double>(end));
  slab_together(from, end);
  BroughtPoints out;
  for (std::size_t row = first; row < first + count; ++row) {
    const std::size_t k = row - slabs_->first;
    out.places.push_back({slabs_->brought.point(static_cast<int>(k))});
    out.levels.push_back(slabs_->levels[k]);
  }
  return out;
}

}  // namespace krater
