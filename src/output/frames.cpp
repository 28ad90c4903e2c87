// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/frames.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <system_error>

#include "krater/core/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/format.hpp"
#include "output/hdf5_file.hpp"
#include "output/xdmf.hpp"

namespace krater::output {
namespace {

namespace fs = std::filesystem;

/// Where a frame is, relative to the results folder.
std::string frame_file(int number) { return "frames/" + six_digits(number) + ".h5"; }

/// The number in `NNNNNN.h5`, nothing for files that are not ours.
std::optional<int> frame_number(const std::string& name) {
  const std::string suffix = ".h5";
  if (!name.ends_with(suffix)) return {};
  const std::string digits = name.substr(0, name.size() - suffix.size());
  const bool ours =
      digits.size() >= 6 && digits.size() <= 9 &&
      std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  return ours ? std::optional<int>(std::stoi(digits)) : std::nullopt;
}

void require(bool condition, const BodyFrame& body, const std::string& problem) {
  if (!condition) throw std::invalid_argument("frame: body '" + body.body + "': " + problem);
}

bool is_usable_name(const std::string& name) {
  return !name.empty() && name != "." && name.find_first_of("/:\n") == std::string::npos;
}

/// The arrays of one group: each at once, or all of them slab by slab where points are brought.
class GroupWriter {
 public:
  GroupWriter(const Node& group, std::size_t rows,
              std::function<void(std::size_t, std::size_t)> bring = {})
      : group_{group}, rows_{rows}, bring_{std::move(bring)} {}

  template <class T>
  std::shared_ptr<const Node> add(const std::string& name, int components, const Rows<T>& values) {
    const Shape shape =
        components == 1 ? Shape{rows_} : Shape{rows_, static_cast<std::uint64_t>(components)};
    if (!bring_ || rows_ < kFewRows) {
      if (bring_ && rows_ > 0) bring_(0, rows_);
      return std::make_shared<const Node>(group_.make_packed<T>(name, shape, values));
    }
    std::uint64_t height = 0;
    const auto dataset =
        std::make_shared<const Node>(group_.make_packed_space<T>(name, shape, height));
    tallest_ = std::max(tallest_, height);
    later_.push_back([dataset, shape, height, values](std::uint64_t first, std::uint64_t end) {
      dataset->pack_rows(shape, height, values, first, end);
    });
    return dataset;
  }
  /// When all are added.
  void finish() {
    for (std::uint64_t first = 0; first < rows_ && !later_.empty(); first += kSlab) {
      const std::uint64_t end = std::min<std::uint64_t>(rows_, first + kSlab);
      bring_(first, std::min<std::uint64_t>(rows_, end + tallest_) - first);
      for (const auto& write : later_) write(first, end);
    }
  }

 private:
  static constexpr std::uint64_t kSlab = 1U << 17U, kFewRows = 1024;
  const Node& group_;
  std::size_t rows_;
  std::function<void(std::size_t, std::size_t)> bring_;
  std::uint64_t tallest_ = 0;
  std::vector<std::function<void(std::uint64_t, std::uint64_t)>> later_;
};

void write_field(GroupWriter& arrays, const BodyFrame& body, const FieldArray& field) {
  require(is_usable_name(field.name), body, "unusable name of a field '" + field.name + "'");
  require(field.components > 0 && field.values, body, "no values of '" + field.name + "'");
  require(field.component_names.empty() ||
              field.component_names.size() == static_cast<std::size_t>(field.components),
          body, "wrong number of component names of '" + field.name + "'");
  const auto dataset = arrays.add(field.name, field.components, field.values);
  dataset->set("unit", field.unit);
  dataset->set("meaning", field.meaning);
  if (!field.component_names.empty()) dataset->set("component_names", field.component_names);
}

void write_coordinates(GroupWriter& arrays, const Rows<double>& values) {
  const auto coordinates = arrays.add("coordinates", 3, values);
  coordinates->set("unit", std::string("m"));
  coordinates->set("meaning", std::string("position (x, y, z); axisymmetric (r, 0, z)"));
  coordinates->set("component_names", std::vector<std::string>{"x", "y", "z"});
}

/// What frames.xmf draws of a body without a mesh.
void write_vertices(GroupWriter& arrays) {
  const Rows<std::int64_t> count = [](std::size_t first, std::size_t number, std::int64_t* out) {
    std::iota(out, out + number, static_cast<std::int64_t>(first));
  };
  const auto topology = arrays.add("cells", 1, count);
  topology->set("meaning", std::string("0, 1, 2, ...: one vertex per point, for frames.xmf"));
}

void write_mesh(const Node& group, GroupWriter& arrays, const BodyFrame& body,
                const FrameMesh& mesh) {
  require(mesh.corners == 8 || mesh.corners == 4, body, "cells of no known kind");
  require(mesh.connectivity && mesh.coordinates, body, "a mesh without cells or nodes");
  const auto cells = arrays.add("connectivity", mesh.corners, mesh.connectivity);
  cells->set("unit", std::string("1"));
  cells->set("meaning", std::string("nodes of each cell: hexahedra bottom counter-clockwise, then "
                                    "the top; quadrilaterals around"));
  const Node nodes = group.make_group("nodes");
  GroupWriter of_nodes{nodes, mesh.nodes};
  write_coordinates(of_nodes, mesh.coordinates);
  for (const auto& field : mesh.fields) write_field(of_nodes, body, field);
}

void write_body(const Node& file, const BodyFrame& body) {
  require(is_usable_name(body.body), body, "unusable name");
  require(body.ids && body.coordinates, body, "no ids or coordinates");
  const Node group = file.make_group(body.body);
  GroupWriter arrays{group, body.points, body.bring};
  const auto ids = arrays.add("id", 1, body.ids);
  ids->set("unit", std::string("1"));
  ids->set("meaning", std::string("number of the point in its body, for ever"));
  write_coordinates(arrays, body.coordinates);
  if (body.mesh)
    write_mesh(group, arrays, body, *body.mesh);
  else
    write_vertices(arrays);
  for (const auto& field : body.fields) write_field(arrays, body, field);
  arrays.finish();
}

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw OutputError(path.string() + ": cannot be removed: " + error.message());
}

}  // namespace

void FrameSeries::remove_all() {
  frames_.clear();
  links_.reset();
  // The lists go first: they must not name frames that are no longer there.
  for (const char* name : {"frames.xmf", "frames.h5"}) {
    remove_file(folder_ + "/" + name);
    remove_file(folder_ + "/" + name + kPartSuffix);
  }
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_ + "/frames", error)) {
    std::string name = entry.path().filename().string();
    if (name.ends_with(kPartSuffix)) name.resize(name.size() - std::string(kPartSuffix).size());
    if (frame_number(name)) remove_file(entry.path());
  }
}

std::size_t FrameSeries::end_of_list() const {
  return frames_.empty() ? kXdmfHead.size() : frames_.back().end;
}

void FrameSeries::load() {
  std::ifstream stream(list(), std::ios::binary);
  frames_ = listed_frames({std::istreambuf_iterator<char>(stream), {}});
  const auto not_a_series = std::adjacent_find(
      frames_.begin(), frames_.end(),
      [](const ListedFrame& a, const ListedFrame& b) { return !(a.time < b.time); });
  if (not_a_series != frames_.end()) frames_.erase(not_a_series + 1, frames_.end());
}

void FrameSeries::truncate_after(double time, const TextAttributes& attributes) {
  const auto first = std::find_if(frames_.begin(), frames_.end(),
                                  [time](const ListedFrame& f) { return f.time > time; });
  const std::vector<ListedFrame> late(first, frames_.end());
  frames_.erase(first, frames_.end());
  if (frames_.empty()) return;
  links_.reset();
  save_links(attributes);
  replace_tail(list(), end_of_list(), kXdmfTail);
  for (const ListedFrame& frame : late) remove_file(folder_ + "/" + frame_file(frame.number));
}

FrameSeries::Written FrameSeries::write(const OutputFrame& frame,
                                        const TextAttributes& attributes) const {
  if (frame.number < 0) throw std::invalid_argument("frame: negative number");
  std::error_code error;
  fs::create_directories(folder_ + "/frames", error);
  if (error) throw OutputError(folder_ + "/frames: cannot be created: " + error.message());
  StreamedFile file(folder_ + "/" + frame_file(frame.number));
  file.set(attributes);
  file.set("time", frame.time);
  file.set("step", frame.step);
  for (const auto& body : frame.bodies) write_body(file, body);
  file.close();
  return {std::move(file), frame.number, frame.time, frame_grid(frame, frame_file(frame.number))};
}

void FrameSeries::commit(Written frame, const TextAttributes& attributes) {
  frame.file.commit();
  // A run that is continued elsewhere may find frames of another one there.
  const auto clash = std::find_if(frames_.begin(), frames_.end(), [&frame](const ListedFrame& f) {
    return f.number >= frame.number || f.time >= frame.time;
  });
  if (clash != frames_.end()) {
    frames_.erase(clash, frames_.end());
    links_.reset();
  }
  if (frames_.empty()) replace_file(list(), std::string(kXdmfHead).append(kXdmfTail));
  const std::size_t begin = end_of_list();
  frames_.push_back({frame.number, frame.time, begin, begin + frame.grid.size()});
  save_links(attributes);
  replace_tail(list(), begin, frame.grid + std::string(kXdmfTail));
}

void FrameSeries::save_links(const TextAttributes& attributes) {
  if (!links_) {
    links_.emplace(folder_ + "/frames.h5");
    links_->set(attributes);
    links_->make_group("frames");
    linked_ = 0;
  }
  for (; linked_ < frames_.size(); ++linked_) {
    const int number = frames_[linked_].number;
    links_->link_external("frames/" + six_digits(number), frame_file(number), "/");
  }
  links_->save();
}

}  // namespace krater::output
