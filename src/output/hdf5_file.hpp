// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/hdf5_file.hpp
/// The little of HDF5 that the program uses, with owners for its identifiers and exceptions for its
/// errors. Small files that are written again and again are built in memory, large ones go straight
/// to disk (output/part_driver.hpp): a full disk must not end a run without its checkpoint, and a
/// file must not need the memory of another simulation. Not thread-safe, as the library.
#include <hdf5.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "krater/output/results.hpp"
#include "output/atomic_file.hpp"

namespace krater::output {

using Shape = std::vector<std::uint64_t>;

/// Owner of one HDF5 identifier.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept;
  Handle& operator=(Handle&& other) noexcept;
  ~Handle();
  hid_t id() const { return id_; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// A file, group or dataset, open for reading or writing. Writing errors are OutputError, reading
/// errors InputError; both name the file.
class Node {
 public:
  enum class Mode { read, write };
  Node(Handle handle, std::string file, Mode mode);

  Node make_group(const std::string& name) const;
  /// `values` may be null when the shape holds no element. Types: double, int64, unsigned char.
  template <class T>
  Node make_dataset(const std::string& name, const Shape& shape, const T* values) const;
  /// Two sizes; written row by row, so that nothing holds the whole.
  Node make_matrix(const std::string& name, const Shape& shape, const Rows<double>& rows) const;
  /// Packed (output/packing.hpp) by all threads, piece by piece. Types: double, int64.
  template <class T>
  Node make_packed(const std::string& name, const Shape& shape, const Rows<T>& rows) const;
  /// The same in parts: room for the rows, of which `height` are packed together ...
  template <class T>
  Node make_packed_space(const std::string& name, const Shape& shape, std::uint64_t& height) const;
  /// ... and in it the packs that begin from row `first` up to `end`.
  template <class T>
  void pack_rows(const Shape& shape, std::uint64_t height, const Rows<T>& rows, std::uint64_t first,
                 std::uint64_t end) const;
  void link_external(const std::string& name, const std::string& file,
                     const std::string& path) const;
  void set(const std::string& attribute, const std::string& text) const;
  void set(const std::string& attribute, double value) const;
  void set(const std::string& attribute, std::int64_t value) const;
  void set(const std::string& attribute, const std::vector<std::string>& texts) const;
  void set(const TextAttributes& attributes) const;

  bool has_attribute(const std::string& name) const;
  std::string text(const std::string& attribute) const;
  double number(const std::string& attribute) const;
  std::int64_t integer(const std::string& attribute) const;
  std::vector<std::string> texts(const std::string& attribute) const;
  Node open_dataset(const std::string& path) const;
  Shape shape() const;
  /// Whole dataset; refuses one stored as another type.
  template <class T>
  std::vector<T> read() const;
  /// Of a dataset of two sizes and doubles.
  void read_rows(std::size_t first, std::size_t count, double* out) const;

  const std::string& file() const { return file_; }

 protected:
  /// Throws when `status` is negative: what was attempted, and why HDF5 says it failed.
  void require(std::int64_t status, const std::string& attempt) const;
  [[noreturn]] void fail(const std::string& problem) const;
  Handle handle_;

 private:
  Node make_space_for(const std::string& name, const Shape& shape, std::int64_t type,
                      std::int64_t creation) const;
  Handle write_attribute(const std::string& name, hid_t type, hid_t space, const void* data) const;
  void read_attribute(const std::string& name, hid_t type, void* data) const;
  std::string file_;
  Mode mode_;
};

/// A file under construction in memory. Objects made in it may outlive it but no longer matter.
class MemoryFile : public Node {
 public:
  explicit MemoryFile(const std::string& path);
  void save();  ///< to its path, all or nothing; again after more was added
};

/// A file that is written as it grows, and has its name when it is committed. What fails meanwhile
/// is told by commit().
class StreamedFile : public Node {
 public:
  enum class Kind { plain, sealed };  ///< sealed: output/seal.hpp
  explicit StreamedFile(const std::string& path, Kind kind = Kind::plain);
  /// Not closed when something was thrown: HDF5 still writes to its part, which must be there.
  ~StreamedFile();
  StreamedFile(StreamedFile&&) = default;
  StreamedFile& operator=(StreamedFile&&) = delete;
  void close();   ///< nothing is added any more; the rest of the work needs no HDF5
  void commit();  ///< once, closed

 private:
  std::unique_ptr<PartFile> part_;
  Kind kind_;
};

/// Opens a file for reading. Throws InputError: missing, unreadable, no HDF5 file, truncated.
Node open_file(const std::string& path);

}  // namespace krater::output
