// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/checkpoint.hpp"

#include <bit>
#include <cstring>
#include <functional>
#include <new>
#include <numeric>
#include <type_traits>

#include "krater/core/errors.hpp"
#include "output/hdf5_file.hpp"

namespace krater {
namespace {

using output::Node;
using output::Shape;

constexpr const char* kMagic = "krater checkpoint";
constexpr std::int64_t kFormat = 1;  ///< raised whenever older programs could misread the file

/// FNV-1a over 64-bit words of the values and of the shape: HDF5 1.10 itself would not notice a
/// flipped bit in data.
template <class T>
std::int64_t checksum(const std::vector<T>& values, const Shape& shape) {
  std::uint64_t sum = 14695981039346656037u;
  const auto add = [&sum](std::uint64_t word) { sum = (sum ^ word) * 1099511628211u; };
  for (const std::uint64_t size : shape) add(size);
  for (const T value : values) {
    if constexpr (sizeof(T) == sizeof(std::uint64_t)) {
      add(std::bit_cast<std::uint64_t>(value));
    } else {
      add(value);
    }
  }
  return std::bit_cast<std::int64_t>(sum);
}

std::uint64_t count(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>{});
}

template <class T>
void write_values(const Node& file, const CheckpointBlob& blob, const std::vector<T>& values) {
  const Shape shape =
      blob.shape.empty() || std::is_same_v<T, unsigned char> ? Shape{values.size()} : blob.shape;
  if (count(shape) != values.size()) {
    throw std::invalid_argument("checkpoint: shape and values of '" + blob.name + "' disagree");
  }
  const Node dataset = file.make_dataset("state/" + blob.name, shape, values.data());
  dataset.set("checksum", checksum(values, shape));
}

void write_blob(const Node& file, const CheckpointBlob& blob) {
  const int filled = !blob.doubles.empty() + !blob.integers.empty() + !blob.text.empty();
  if (blob.name.empty() || filled > 1) {
    throw std::invalid_argument("checkpoint: '" + blob.name +
                                "' needs a name and one kind of data");
  }
  if (!blob.text.empty()) {
    write_values(file, blob, std::vector<unsigned char>(blob.text.begin(), blob.text.end()));
  } else if (!blob.integers.empty()) {
    write_values(file, blob, blob.integers);
  } else {
    write_values(file, blob, blob.doubles);
  }
}

template <class T>
std::vector<T> read_values(const Node& dataset, const std::string& name) {
  auto values = dataset.read<T>();
  if (checksum(values, dataset.shape()) != dataset.integer("checksum")) {
    throw InputError(dataset.file() + ": damaged: wrong checksum of '" + name + "'");
  }
  return values;
}

CheckpointBlob read_blob(const Node& file, const std::string& name, const std::string& kind) {
  const Node dataset = file.open_dataset("state/" + name);
  CheckpointBlob blob;
  blob.name = name;
  blob.shape = dataset.shape();
  if (kind == "doubles") {
    blob.doubles = read_values<double>(dataset, name);
  } else if (kind == "integers") {
    blob.integers = read_values<std::int64_t>(dataset, name);
  } else {
    const auto bytes = read_values<unsigned char>(dataset, name);
    blob.text.assign(bytes.begin(), bytes.end());
    blob.shape.clear();
  }
  return blob;
}

void check_header(const Node& file) {
  if (!file.has_attribute("magic") || !file.has_attribute("format") ||
      file.text("magic") != kMagic) {
    throw InputError(file.file() + ": not a checkpoint of krater");
  }
  if (const auto format = file.integer("format"); format != kFormat) {
    throw InputError(file.file() + ": checkpoint of format " + std::to_string(format) +
                     ", this program reads format " + std::to_string(kFormat) +
                     "; use the version of krater that wrote it" +
                     (file.has_attribute("version") ? " (" + file.text("version") + ")" : ""));
  }
}

}  // namespace

namespace output {

void save_checkpoint(const std::string& path, const Checkpoint& checkpoint,
                     const TextAttributes& attributes) {
  MemoryFile file(path);
  file.set("magic", std::string(kMagic));
  file.set("format", kFormat);
  file.set(attributes);
  std::vector<std::string> names, kinds;
  for (const auto& blob : checkpoint.blobs) {
    write_blob(file, blob);
    names.push_back(blob.name);
    kinds.emplace_back(!blob.text.empty()       ? "text"
                       : !blob.integers.empty() ? "integers"
                                                : "doubles");
  }
  // HDF5 lists names alphabetically; the program's order is kept here.
  const Node order = file.make_dataset<std::int64_t>("order", {0}, nullptr);
  order.set("names", names);
  order.set("kinds", kinds);
  file.save();
}

}  // namespace output

const CheckpointBlob* Checkpoint::find(const std::string& name) const {
  for (const auto& blob : blobs) {
    if (blob.name == name) return &blob;
  }
  return nullptr;
}

Checkpoint read_checkpoint(const std::string& path) {
  const Node file = output::open_file(path);
  check_header(file);
  try {
    const Node order = file.open_dataset("order");
    const auto names = order.texts("names"), kinds = order.texts("kinds");
    if (names.size() != kinds.size()) throw InputError(path + ": damaged: list of contents");
    Checkpoint checkpoint;
    for (std::size_t i = 0; i < names.size(); ++i) {
      checkpoint.blobs.push_back(read_blob(file, names[i], kinds[i]));
    }
    return checkpoint;
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": larger than memory, or damaged");
  } catch (const std::length_error&) {
    throw InputError(path + ": damaged: impossible size");
  }
}

}  // namespace krater
