// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>

#include "krater/core/parallel.hpp"
#include "output/hdf5_detail.hpp"
#include "output/hdf5_file.hpp"
#include "output/packing.hpp"

namespace krater::output {

using namespace hdf5_detail;

namespace {

constexpr std::uint64_t kWorthPacking = 128;     // values: below, the chunk's index costs more
constexpr std::uint64_t kChunkValues = 1 << 16;  // half a MB: HDF5's cache of chunks holds two
constexpr std::size_t kChunksPerThread = 4;      // packed at once: what waits to be written
constexpr unsigned kNoDeflate = 2;               // filter mask: the second was left out

std::uint64_t product(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>{});
}

/// Numbers of one row.
std::uint64_t width_of(const Shape& shape) {
  return product({shape.begin() + (shape.empty() ? 0 : 1), shape.end()});
}

/// Chunks of whole rows through the filters of output/packing.hpp. Returns rows per chunk.
std::uint64_t set_filters(hid_t creation, const Shape& shape) {
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  chunk[0] = std::clamp<hsize_t>(kChunkValues / width_of(shape), 1, chunk[0]);
  H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  H5Pset_shuffle(creation);
  H5Pset_deflate(creation, 1);
  return chunk[0];
}

/// A thread's share of the packing.
template <class T>
class ChunkMaker {
 public:
  struct Chunk {
    std::vector<unsigned char> bytes;
    unsigned mask;
  };
  /// The chunk from row `first` on; beyond the last row zeros.
  Chunk make(const Rows<T>& rows, const Shape& shape, std::uint64_t first, std::uint64_t height) {
    const std::uint64_t width = width_of(shape), count = std::min(height, shape[0] - first);
    values_.assign(height * width, T{});
    rows(first, count, values_.data());
    words_.resize(values_.size());
    std::memcpy(words_.data(), values_.data(), 8 * words_.size());
    const Packer::Packed packed = packer_.pack(words_);
    return {{packed.bytes.begin(), packed.bytes.end()}, packed.plain ? kNoDeflate : 0};
  }

 private:
  std::vector<T> values_;
  std::vector<std::uint64_t> words_;
  Packer packer_;
};

}  // namespace

Node Node::make_group(const std::string& name) const {
  const QuietErrors quiet;
  const hid_t id = H5Gcreate2(handle_.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  require(id, "group '" + name + "'");
  return {Handle(id, H5Gclose), file_, mode_};
}

Node Node::make_space_for(const std::string& name, const Shape& shape, std::int64_t type,
                          std::int64_t creation) const {
  const Handle space = make_space(shape);
  require(space.id(), "dataset '" + name + "'");
  const Handle parents(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(parents.id(), 1);
  // Without times of creation the same results are the same bytes.
  H5Pset_obj_track_times(creation, false);
  const hid_t id =
      H5Dcreate2(handle_.id(), name.c_str(), type, space.id(), parents.id(), creation, H5P_DEFAULT);
  require(id, "dataset '" + name + "'");
  return {Handle(id, H5Dclose), file_, mode_};
}

template <class T>
Node Node::make_dataset(const std::string& name, const Shape& shape, const T* values) const {
  const QuietErrors quiet;
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  Node dataset = make_space_for(name, shape, file_type<T>(), creation.id());
  if (product(shape) > 0)
    require(H5Dwrite(dataset.handle_.id(), memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values),
            "dataset '" + name + "'");
  return dataset;
}

template Node Node::make_dataset(const std::string&, const Shape&, const double*) const;
template Node Node::make_dataset(const std::string&, const Shape&, const std::int64_t*) const;
template Node Node::make_dataset(const std::string&, const Shape&, const unsigned char*) const;

Node Node::make_matrix(const std::string& name, const Shape& shape,
                       const Rows<double>& rows) const {
  const QuietErrors quiet;
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
  Node dataset = make_space_for(name, shape, file_type<double>(), creation.id());
  if (product(shape) == 0) return dataset;
  const Handle space(H5Dget_space(dataset.handle_.id()), H5Sclose);
  const Handle line = make_space({1, shape[1]});
  std::vector<double> values(shape[1]);
  for (hsize_t r = 0; r < shape[0]; ++r) {
    rows(r, 1, values.data());
    const hsize_t begin[] = {r, 0}, count[] = {1, shape[1]};
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin, nullptr, count, nullptr);
    require(H5Dwrite(dataset.handle_.id(), memory_type<double>(), line.id(), space.id(),
                     H5P_DEFAULT, values.data()),
            "dataset '" + name + "'");
  }
  return dataset;
}

template <class T>
Node Node::make_packed(const std::string& name, const Shape& shape, const Rows<T>& rows) const {
  if (product(shape) < kWorthPacking) {
    std::vector<T> values(product(shape));
    if (!values.empty()) rows(0, shape[0], values.data());
    return make_dataset(name, shape, values.data());
  }
  std::uint64_t height = 0;
  Node dataset = make_packed_space<T>(name, shape, height);
  dataset.pack_rows(shape, height, rows, 0, shape[0]);
  return dataset;
}

template <class T>
Node Node::make_packed_space(const std::string& name, const Shape& shape,
                             std::uint64_t& height) const {
  const QuietErrors quiet;
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
  height = set_filters(creation.id(), shape);
  return make_space_for(name, shape, file_type<T>(), creation.id());
}

template <class T>
void Node::pack_rows(const Shape& shape, std::uint64_t height, const Rows<T>& rows,
                     std::uint64_t first, std::uint64_t end) const {
  const QuietErrors quiet;
  const auto threads_at_work = static_cast<std::size_t>(threads());
  std::vector<ChunkMaker<T>> makers(threads_at_work);
  std::vector<typename ChunkMaker<T>::Chunk> chunks(kChunksPerThread * threads_at_work);
  const std::uint64_t last = (end + height - 1) / height;
  for (std::uint64_t done = (first + height - 1) / height; done < last; done += chunks.size()) {
    const std::size_t now = std::min<std::size_t>(chunks.size(), last - done);
    for_each(now, [&](std::size_t i) {
      ChunkMaker<T>& maker = makers[static_cast<std::size_t>(thread_index())];
      chunks[i] = maker.make(rows, shape, (done + i) * height, height);
    });
    for (std::size_t i = 0; i < now; ++i) {
      std::vector<hsize_t> place(shape.size(), 0);
      place[0] = (done + i) * height;
      require(H5Dwrite_chunk(handle_.id(), H5P_DEFAULT, chunks[i].mask, place.data(),
                             chunks[i].bytes.size(), chunks[i].bytes.data()),
              "a dataset");
    }
  }
}

template Node Node::make_packed(const std::string&, const Shape&, const Rows<double>&) const;
template Node Node::make_packed(const std::string&, const Shape&, const Rows<std::int64_t>&) const;
template Node Node::make_packed_space<double>(const std::string&, const Shape&,
                                              std::uint64_t&) const;
template Node Node::make_packed_space<std::int64_t>(const std::string&, const Shape&,
                                                    std::uint64_t&) const;
template void Node::pack_rows(const Shape&, std::uint64_t, const Rows<double>&, std::uint64_t,
                              std::uint64_t) const;
template void Node::pack_rows(const Shape&, std::uint64_t, const Rows<std::int64_t>&, std::uint64_t,
                              std::uint64_t) const;

void Node::link_external(const std::string& name, const std::string& file,
                         const std::string& path) const {
  const QuietErrors quiet;
  require(H5Lcreate_external(file.c_str(), path.c_str(), handle_.id(), name.c_str(), H5P_DEFAULT,
                             H5P_DEFAULT),
          "link '" + name + "'");
}

Handle Node::write_attribute(const std::string& name, hid_t type, hid_t space,
                             const void* data) const {
  const std::string attempt = "attribute '" + name + "'";
  Handle attribute(H5Acreate2(handle_.id(), name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  require(attribute.id(), attempt);
  require(H5Awrite(attribute.id(), type, data), attempt);
  return attribute;
}

void Node::set(const std::string& attribute, const std::string& text) const {
  const QuietErrors quiet;
  const char* data = text.c_str();
  write_attribute(attribute, text_type().id(), make_space({}).id(), &data);
}

void Node::set(const std::string& attribute, double value) const {
  const QuietErrors quiet;
  write_attribute(attribute, H5T_IEEE_F64LE, make_space({}).id(), &value);
}

void Node::set(const std::string& attribute, std::int64_t value) const {
  const QuietErrors quiet;
  write_attribute(attribute, H5T_STD_I64LE, make_space({}).id(), &value);
}

void Node::set(const std::string& attribute, const std::vector<std::string>& texts) const {
  const QuietErrors quiet;
  std::vector<const char*> data;
  for (const auto& text : texts) data.push_back(text.c_str());
  write_attribute(attribute, text_type().id(), make_space({texts.size()}).id(), data.data());
}

void Node::set(const TextAttributes& attributes) const {
  for (const auto& [name, text] : attributes) set(name, text);
}

}  // namespace krater::output
