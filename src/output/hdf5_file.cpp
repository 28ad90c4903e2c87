// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/hdf5_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <numeric>
#include <utility>

#include "krater/core/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/hdf5_detail.hpp"
#include "output/part_driver.hpp"
#include "output/seal.hpp"

namespace krater::output {

using namespace hdf5_detail;

namespace {

// A file in memory grows piece by piece: HDF5 clears every piece.
constexpr std::size_t kGrowth = 1 << 16;  // bytes

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

void Node::read_rows(std::size_t first, std::size_t count, double* out) const {
  const QuietErrors quiet;
  const Shape sizes = shape();
  if (sizes.size() != 2 || first + count > sizes[0]) fail("a matrix has another size");
  if (sizes[1] == 0) return;
  const Handle space(H5Dget_space(handle_.id()), H5Sclose), rows = make_space({count, sizes[1]});
  const hsize_t begin[] = {first, 0}, number[] = {count, sizes[1]};
  H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, begin, nullptr, number, nullptr);
  require(H5Dread(handle_.id(), memory_type<double>(), rows.id(), space.id(), H5P_DEFAULT, out),
          "data");
}

// ---------------------------------------------------------------------------------------- files

MemoryFile::MemoryFile(const std::string& path) : Node({}, path, Mode::write) {
  const QuietErrors quiet;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  require(H5Pset_fapl_core(access.id(), kGrowth, false), "file in memory");
  handle_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
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
  replace_file(file(), {*static_cast<char**>(image), static_cast<std::size_t>(size)});
}

StreamedFile::StreamedFile(const std::string& path, Kind kind)
    : Node({}, path, Mode::write), part_{std::make_unique<PartFile>(path)}, kind_{kind} {
  const QuietErrors quiet;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  require(use_part_file(access.id(), *part_), "driver");
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  if (kind == Kind::sealed) require(H5Pset_userblock(creation.id(), kSealBytes), "user block");
  handle_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  require(handle_.id(), "file");
}

StreamedFile::~StreamedFile() {
  const QuietErrors quiet;
  handle_ = Handle{};
}

void StreamedFile::close() {
  const QuietErrors quiet;
  require(H5Fflush(handle_.id(), H5F_SCOPE_GLOBAL), "flush");
  handle_ = Handle{};
}

void StreamedFile::commit() {
  if (kind_ == Kind::sealed) seal(*part_);
  part_->commit();
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
