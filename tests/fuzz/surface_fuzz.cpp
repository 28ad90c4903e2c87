// SPDX-License-Identifier: GPL-3.0-or-later
// Target of libFuzzer (tools/fuzz stl, off, obj, ply; the format by KRATER_FUZZ_FORMAT): any bytes
// are a surface that is read, mended, looked at and made a solid, or refused by name, as a scene's
// shape is (scene/readers/read_surface.cpp); without repairs, and with all of them.
#include <array>
#include <stdexcept>

#include "fuzz/fuzz_file.hpp"
#include "krater/geometry/surfaces/surface.hpp"

namespace {

void read_as_shape(const std::string& file, const krater::RepairOptions& repair) {
  krater::Triangles triangles = krater::read_triangles(file, 1e-3);
  krater::repair_surface(triangles, repair);
  const krater::SurfaceDefects defects = krater::examine_surface(triangles);
  if (!defects.any()) {
    krater::make_surface_solid(std::move(triangles));
  } else if (defects.text(1e-3, "mm").empty()) {
    std::abort();
  }
}

const char* format() {
  const char* told = std::getenv("KRATER_FUZZ_FORMAT");
  return told == nullptr ? "stl" : told;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const krater::fuzz::MemoryFile file{format()};
  static const std::array<krater::RepairOptions, 2> ways{{{}, {1e-6, true, true, 1}}};
  if (!file.write(data, size)) return 0;
  for (const krater::RepairOptions& way : ways) {
    try {
      read_as_shape(file.path(), way);
    } catch (const std::invalid_argument& error) {
      krater::fuzz::require_reason(error);
    }
  }
  return 0;
}
