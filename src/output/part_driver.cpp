// SPDX-License-Identifier: GPL-3.0-or-later
#include "output/part_driver.hpp"

#include <algorithm>
#include <iterator>
#include <new>

namespace krater::output {
namespace {

/// What a file access list carries: copied as bytes.
struct Access {
  PartFile* file;
};

/// HDF5 sees the first member, as C's inheritance has it.
struct OpenFile {
  H5FD_t base;
  PartFile* file;
  haddr_t allotted;  ///< end of the addresses handed out
};

OpenFile& of(H5FD_t* file) { return *reinterpret_cast<OpenFile*>(file); }
const OpenFile& of(const H5FD_t* file) { return *reinterpret_cast<const OpenFile*>(file); }

H5FD_t* open(const char*, unsigned, hid_t access, haddr_t) {
  const auto* info = static_cast<const Access*>(H5Pget_driver_info(access));
  if (info == nullptr) return nullptr;
  auto* file = new (std::nothrow) OpenFile{{}, info->file, 0};
  return file != nullptr ? &file->base : nullptr;
}

herr_t close(H5FD_t* file) {
  delete &of(file);
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t allotted(const H5FD_t* file, H5FD_mem_t) { return of(file).allotted; }

herr_t allot(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  of(file).allotted = end;
  return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) { return of(file).file->size(); }

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, size_t size, void* buffer) {
  of(file).file->read(at, buffer, size);
  return 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, size_t size, const void* buffer) {
  of(file).file->write(at, buffer, size);
  return 0;
}

/// A file shorter than the addresses handed out counts as cut short.
herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  const char zero = 0;
  const OpenFile& f = of(file);
  if (f.file->size() < f.allotted) f.file->write(f.allotted - 1, &zero, 1);
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver{};
#if H5_VERSION_GE(1, 14, 0)
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(512);  // the range of drivers outside HDF5
#endif
  driver.name = "krater part file";
  driver.maxaddr = (haddr_t{1} << 62) - 1;
  driver.fc_degree = H5F_CLOSE_STRONG;  // datasets may outlive their file but no longer matter
  driver.fapl_size = sizeof(Access);
  driver.open = open;
  driver.close = close;
  driver.query = query;
  driver.get_eoa = allotted;
  driver.set_eoa = allot;
  driver.get_eof = end_of_file;
  driver.read = read;
  driver.write = write;
  driver.truncate = truncate;
  const H5FD_mem_t one_list[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(one_list), std::end(one_list), driver.fl_map);
  return driver;
}

}  // namespace

herr_t use_part_file(hid_t access, PartFile& file) {
  static const H5FD_class_t driver = driver_class();
  static const hid_t number = H5FDregister(&driver);
  const Access info{&file};
  return H5Pset_driver(access, number, &info);
}

}  // namespace krater::output
