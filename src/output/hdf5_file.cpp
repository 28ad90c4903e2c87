// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/hdf5_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <numeric>
#include <type_traits>
#include <utility>

#include "krater/core/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/seal.hpp"

namespace krater::output {
namespace {

/// HDF5 prints its error stack unless told otherwise; restored for the sake of other users.
class QuietErrors {
 public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

herr_t keep_deepest(unsigned depth, const H5E_error2_t* error, void* text) {
  if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

/// The innermost message of HDF5's error stack, reduced to the system's reason where there is one.
std::string deepest_error() {
  std::string text = "no reason given";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_deepest, &text);
  const std::string key = "error message = '";
  if (const auto begin = text.find(key); begin != std::string::npos) {
    const auto end = text.find('\'', begin + key.size());
    return text.substr(begin + key.size(), end - begin - key.size());
  }
  return text;
}

template <class T>
hid_t file_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_STD_I64LE;
  return H5T_STD_U8LE;
}

template <class T>
hid_t memory_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  return H5T_NATIVE_UCHAR;
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

Handle make_space(const Shape& shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose};
}

// The file in memory grows by a sixteenth of what it will hold: HDF5 clears every piece, and moves
// what is there when a piece is added.
constexpr std::size_t kLeastGrowth = 1 << 16, kMostGrowth = 1 << 22;  // bytes

constexpr std::uint64_t kWorthPacking = 128;     // values: below, the chunk's index costs more
constexpr std::uint64_t kChunkValues = 1 << 16;  // half a MB: HDF5's cache of chunks holds two

/// Bytes sorted by weight, then zlib's fastest level: higher ones gain 1 %, at up to twice the
/// time.
void pack(hid_t creation, const Shape& shape) {
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  hsize_t row = 1;
  for (std::size_t k = 1; k < chunk.size(); ++k) row *= chunk[k];
  chunk[0] = std::clamp<hsize_t>(kChunkValues / row, 1, chunk[0]);
  H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  H5Pset_shuffle(creation);
  H5Pset_deflate(creation, 1);
}

}  // namespace

Handle::Handle(Handle&& other) noexcept
    : id_(std::exchange(other.id_, -1)), close_(std::exchange(other.close_, nullptr)) {}

Handle& Handle::operator=(Handle&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(close_, other.close_);
  return *this;
}

Handle::~Handle() {
  const QuietErrors quiet;
  if (id_ >= 0 && close_ != nullptr) close_(id_);
}

Node::Node(Handle handle, std::string file, Mode mode)
    : handle_(std::move(handle)), file_(std::move(file)), mode_(mode) {}

void Node::fail(const std::string& problem) const {
  if (mode_ == Mode::read) throw InputError(file_ + ": " + problem);
  throw OutputError(file_ + ": cannot be written: " + problem);
}

void Node::require(std::int64_t status, const std::string& attempt) const {
  if (status < 0) fail(attempt + ": " + deepest_error());
}

// -------------------------------------------------------------------------------------- writing

Node Node::make_group(const std::string& name) const {
  const QuietErrors quiet;
  const hid_t id = H5Gcreate2(handle_.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  require(id, "group '" + name + "'");
  return {Handle(id, H5Gclose), file_, mode_};
}

template <class T>
Node Node::make_dataset(const std::string& name, const Shape& shape, const T* values,
                        Storage storage) const {
  const QuietErrors quiet;
  const std::string attempt = "dataset '" + name + "'";
  const auto count =
      std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>{});
  const Handle space = make_space(shape);
  require(space.id(), attempt);
  const Handle parents(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(parents.id(), 1);
  // Without times of creation the same results are the same bytes.
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);
  if (storage == Storage::compressed && count >= kWorthPacking) pack(creation.id(), shape);
  const hid_t id = H5Dcreate2(handle_.id(), name.c_str(), file_type<T>(), space.id(), parents.id(),
                              creation.id(), H5P_DEFAULT);
  require(id, attempt);
  Node dataset(Handle(id, H5Dclose), file_, mode_);
  if (count > 0) {
    require(H5Dwrite(id, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values), attempt);
  }
  return dataset;
}

template Node Node::make_dataset(const std::string&, const Shape&, const double*, Storage) const;
template Node Node::make_dataset(const std::string&, const Shape&, const std::int64_t*,
                                 Storage) const;
template Node Node::make_dataset(const std::string&, const Shape&, const unsigned char*,
                                 Storage) const;

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

// -------------------------------------------------------------------------------------- reading

bool Node::has_attribute(const std::string& name) const {
  const QuietErrors quiet;
  return H5Aexists(handle_.id(), name.c_str()) > 0;
}

void Node::read_attribute(const std::string& name, hid_t type, void* data) const {
  const std::string attempt = "attribute '" + name + "'";
  const Handle attribute(H5Aopen(handle_.id(), name.c_str(), H5P_DEFAULT), H5Aclose);
  require(attribute.id(), attempt);
  require(H5Aread(attribute.id(), type, data), attempt);
}

std::string Node::text(const std::string& attribute) const {
  const auto all = texts(attribute);
  if (all.size() != 1) fail("attribute '" + attribute + "': one text expected");
  return all.front();
}

double Node::number(const std::string& attribute) const {
  const QuietErrors quiet;
  double value = 0;
  read_attribute(attribute, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::int64_t Node::integer(const std::string& attribute) const {
  const QuietErrors quiet;
  std::int64_t value = 0;
  read_attribute(attribute, H5T_NATIVE_INT64, &value);
  return value;
}

std::vector<std::string> Node::texts(const std::string& attribute) const {
  const QuietErrors quiet;
  const std::string attempt = "attribute '" + attribute + "'";
  const Handle opened(H5Aopen(handle_.id(), attribute.c_str(), H5P_DEFAULT), H5Aclose);
  require(opened.id(), attempt);
  const Handle space(H5Aget_space(opened.id()), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  require(count, attempt);
  const Handle type = text_type();
  std::vector<char*> data(static_cast<std::size_t>(count), nullptr);
  require(H5Aread(opened.id(), type.id(), data.data()), attempt);
  std::vector<std::string> result;
  for (const char* item : data) result.emplace_back(item != nullptr ? item : "");
  H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, data.data());
  return result;
}

Node Node::open_dataset(const std::string& path) const {
  const QuietErrors quiet;
  const hid_t id = H5Dopen2(handle_.id(), path.c_str(), H5P_DEFAULT);
  require(id, "dataset '" + path + "'");
  return {Handle(id, H5Dclose), file_, mode_};
}

Shape Node::shape() const {
  const QuietErrors quiet;
  const Handle space(H5Dget_space(handle_.id()), H5Sclose);
  require(space.id(), "shape");
  std::vector<hsize_t> sizes(H5S_MAX_RANK);
  const int rank = H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr);
  require(rank, "shape");
  return {sizes.begin(), sizes.begin() + rank};
}

template <class T>
std::vector<T> Node::read() const {
  const QuietErrors quiet;
  const Handle type(H5Dget_type(handle_.id()), H5Tclose);
  require(type.id(), "type");
  if (H5Tequal(type.id(), file_type<T>()) <= 0) fail("a dataset is stored as another type");
  const Shape sizes = shape();
  std::vector<T> values(
      std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{1}, std::multiplies<>{}));
  if (!values.empty()) {
    require(H5Dread(handle_.id(), memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
            "data");
  }
  return values;
}

template std::vector<double> Node::read() const;
template std::vector<std::int64_t> Node::read() const;
template std::vector<unsigned char> Node::read() const;

// ---------------------------------------------------------------------------------------- files

MemoryFile::MemoryFile(const std::string& path, Kind kind, std::size_t bytes)
    : Node({}, path, Mode::write), kind_(kind) {
  const QuietErrors quiet;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const std::size_t growth = std::clamp(bytes / 16, kLeastGrowth, kMostGrowth);
  require(H5Pset_fapl_core(access.id(), growth, false), "file in memory");
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  if (kind == Kind::sealed) require(H5Pset_userblock(creation.id(), kSealBytes), "user block");
  handle_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  require(handle_.id(), "file in memory");
}

void MemoryFile::save() {
  const QuietErrors quiet;
  require(H5Fflush(handle_.id(), H5F_SCOPE_GLOBAL), "flush");
  // The library's own buffer: H5Fget_file_image would copy it once more; it is asked for the size
  // only.
  const ssize_t size = H5Fget_file_image(handle_.id(), nullptr, 0);
  require(size, "size of the file");
  void* image = nullptr;
  require(H5Fget_vfd_handle(handle_.id(), H5P_DEFAULT, &image), "file in memory");
  char* bytes = *static_cast<char**>(image);
  auto length = static_cast<std::size_t>(size);  // of what HDF5 wrote
  if (kind_ == Kind::sealed) {
    length += kSealBytes;
    seal(bytes, length);
  }
  replace_file(file(), {bytes, length});
}

Node open_file(const std::string& path) {
  const QuietErrors quiet;
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw InputError(path + ": cannot be read: " + reason(errno));
  struct stat status {};
  const bool plain = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  ::close(descriptor);
  if (!plain) throw InputError(path + ": cannot be read: not a plain file");
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // Files never change once they have their name, so locks (which some file systems lack) serve
  // nothing.
  H5Pset_file_locking(access.id(), false, true);
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (file.id() < 0) {
    throw InputError(path + ": not an HDF5 file, or truncated (" + deepest_error() + ")");
  }
  return {std::move(file), path, Node::Mode::read};
}

}  // namespace krater::output
