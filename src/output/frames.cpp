// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/frames.hpp"

#include <algorithm>
#include <filesystem>
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

void write_field(const Node& group, const BodyFrame& body, const FieldArray& field) {
  const std::size_t points = body.ids.size();
  require(is_usable_name(field.name), body, "unusable name of a field '" + field.name + "'");
  require(field.components > 0 &&
              field.values.size() == points * static_cast<std::size_t>(field.components),
          body, "wrong number of values of '" + field.name + "'");
  require(field.component_names.empty() ||
              field.component_names.size() == static_cast<std::size_t>(field.components),
          body, "wrong number of component names of '" + field.name + "'");
  const Shape shape = field.components == 1
                          ? Shape{points}
                          : Shape{points, static_cast<std::uint64_t>(field.components)};
  const Node dataset = group.make_dataset(field.name, shape, field.values.data());
  dataset.set("unit", field.unit);
  dataset.set("meaning", field.meaning);
  if (!field.component_names.empty()) dataset.set("component_names", field.component_names);
}

void write_body(const Node& file, const BodyFrame& body) {
  const std::size_t points = body.ids.size();
  require(is_usable_name(body.body), body, "unusable name");
  require(body.coordinates.size() == 3 * points, body, "three coordinates per point expected");
  const Node group = file.make_group(body.body);
  const Node ids = group.make_dataset("id", {points}, body.ids.data());
  ids.set("unit", std::string("1"));
  ids.set("meaning", std::string("number of the point in its body, for ever"));
  const Node coordinates = group.make_dataset("coordinates", {points, 3}, body.coordinates.data());
  coordinates.set("unit", std::string("m"));
  coordinates.set("meaning", std::string("position (x, y, z); axisymmetric (r, 0, z)"));
  coordinates.set("component_names", std::vector<std::string>{"x", "y", "z"});
  std::vector<std::int64_t> cells(points);
  std::iota(cells.begin(), cells.end(), 0);
  const Node topology = group.make_dataset("cells", {points}, cells.data());
  topology.set("meaning", std::string("0, 1, 2, ...: one vertex per point, for frames.xmf"));
  for (const auto& field : body.fields) write_field(group, body, field);
}

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw OutputError(path.string() + ": cannot be removed: " + error.message());
}

}  // namespace

void FrameSeries::remove_all() {
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

void FrameSeries::load() {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_ + "/frames", error)) {
    const auto number = frame_number(entry.path().filename().string());
    if (!number) continue;
    try {
      const Node file = open_file(entry.path().string());
      times_[*number] = file.number("time");
      grids_[*number] = file.text("xdmf");
    } catch (const InputError&) {
      times_.erase(*number);  // not a frame; a later frame of this number replaces it
    }
  }
}

void FrameSeries::truncate_after(double time, const TextAttributes& attributes) {
  std::vector<int> late;
  for (const auto& [number, frame_time] : times_) {
    if (frame_time > time) late.push_back(number);
  }
  if (late.empty()) return;
  for (const int number : late) {
    times_.erase(number);
    grids_.erase(number);
  }
  write_index(attributes);
  for (const int number : late) remove_file(folder_ + "/" + frame_file(number));
}

void FrameSeries::write(const OutputFrame& frame, const TextAttributes& attributes) {
  if (frame.number < 0) throw std::invalid_argument("frame: negative number");
  std::error_code error;
  fs::create_directories(folder_ + "/frames", error);
  if (error) throw OutputError(folder_ + "/frames: cannot be created: " + error.message());
  const std::string grid = frame_grid(frame, frame_file(frame.number));
  MemoryFile file(folder_ + "/" + frame_file(frame.number));
  file.set(attributes);
  file.set("time", frame.time);
  file.set("step", frame.step);
  file.set("xdmf", grid);  // a restarted run lists this frame in frames.xmf without reading it
  for (const auto& body : frame.bodies) write_body(file, body);
  file.save();
  times_[frame.number] = frame.time;
  grids_[frame.number] = grid;
  write_index(attributes);
}

void FrameSeries::write_index(const TextAttributes& attributes) const {
  MemoryFile file(folder_ + "/frames.h5");
  file.set(attributes);
  const Node frames = file.make_group("frames");
  for (const auto& [number, grid] : grids_) {
    frames.link_external(six_digits(number), frame_file(number), "/");
  }
  file.save();
  replace_file(folder_ + "/frames.xmf", xdmf_document(grids_));
}

}  // namespace krater::output
