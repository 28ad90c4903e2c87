// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/checkpoint.hpp"

#include <functional>
#include <memory>
#include <new>
#include <numeric>
#include <sstream>
#include <type_traits>

#include "krater/core/errors.hpp"
#include "output/hdf5_file.hpp"
#include "output/seal.hpp"

namespace krater {
namespace {

using output::Node;
using output::Shape;

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
  file.make_dataset("state/" + blob.name, shape, values.data());
}

void write_blob(const Node& file, const CheckpointBlob& blob) {
  const int filled =
      !blob.doubles.empty() + !blob.integers.empty() + !blob.text.empty() + bool{blob.matrix};
  if (blob.name.empty() || blob.name.find('\n') != std::string::npos || filled > 1) {
    throw std::invalid_argument("checkpoint: '" + blob.name +
                                "' needs a name of one line and one kind of data");
  }
  if (blob.matrix) {
    if (blob.shape.size() != 2)
      throw std::invalid_argument("checkpoint: '" + blob.name + "' is no matrix");
    file.make_matrix("state/" + blob.name, blob.shape, blob.matrix);
  } else if (!blob.text.empty()) {
    write_values(file, blob, std::vector<unsigned char>(blob.text.begin(), blob.text.end()));
  } else if (!blob.integers.empty()) {
    write_values(file, blob, blob.integers);
  } else {
    write_values(file, blob, blob.doubles);
  }
}

const char* kind_of(const CheckpointBlob& blob) {
  if (blob.matrix) return "matrix";
  return !blob.text.empty() ? "text" : !blob.integers.empty() ? "integers" : "doubles";
}

CheckpointBlob read_blob(const Node& file, const std::string& name, const std::string& kind) {
  const Node dataset = file.open_dataset("state/" + name);
  CheckpointBlob blob;
  blob.name = name;
  blob.shape = dataset.shape();
  if (kind == "matrix") {
    blob.matrix = [rows = std::make_shared<const Node>(file.open_dataset("state/" + name))](
                      std::size_t first, std::size_t number, double* out) {
      rows->read_rows(first, number, out);
    };
  } else if (kind == "doubles") {
    blob.doubles = dataset.read<double>();
  } else if (kind == "integers") {
    blob.integers = dataset.read<std::int64_t>();
  } else {
    const auto bytes = dataset.read<unsigned char>();
    blob.text.assign(bytes.begin(), bytes.end());
    blob.shape.clear();
  }
  return blob;
}

}  // namespace

namespace output {

void save_checkpoint(const std::string& path, const Checkpoint& checkpoint,
                     const TextAttributes& attributes) {
  StreamedFile file(path, StreamedFile::Kind::sealed);
  file.set(attributes);
  std::string order;  // HDF5 lists names alphabetically; the program's order is kept here
  for (const auto& blob : checkpoint.blobs) {
    write_blob(file, blob);
    order += std::string(kind_of(blob)) + " " + blob.name + "\n";
  }
  // A dataset: an attribute holds 64 KiB, which is 4087 names.
  const std::vector<unsigned char> bytes(order.begin(), order.end());
  file.make_dataset("order", {bytes.size()}, bytes.data());
  file.close();
  file.commit();
}

}  // namespace output

const CheckpointBlob* Checkpoint::find(const std::string& name) const {
  for (const auto& blob : blobs) {
    if (blob.name == name) return &blob;
  }
  return nullptr;
}

Checkpoint read_checkpoint(const std::string& path) {
  output::require_sealed(path);
  const Node file = output::open_file(path);
  try {
    const auto bytes = file.open_dataset("order").read<unsigned char>();
    std::istringstream order{std::string(bytes.begin(), bytes.end())};
    Checkpoint checkpoint;
    for (std::string kind, name; order >> kind && std::getline(order.ignore(), name);) {
      checkpoint.blobs.push_back(read_blob(file, name, kind));
    }
    return checkpoint;
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": larger than memory");
  }
}

}  // namespace krater
