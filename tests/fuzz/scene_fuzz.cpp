// SPDX-License-Identifier: GPL-3.0-or-later
// Target of libFuzzer (tools/fuzz): any bytes are a scene file that is read, or refused by name.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "krater/core/errors.hpp"
#include "krater/scene/scene.hpp"

namespace {

/// A file that lives in memory, in a folder without cards or meshes.
const std::string& scene_file() {
  static const std::string path = "/dev/shm/krater_fuzz_" + std::to_string(getpid()) + ".yaml";
  static const int at_exit = std::atexit([] { std::remove(scene_file().c_str()); });
  static_cast<void>(at_exit);
  return path;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::FILE* file = std::fopen(scene_file().c_str(), "wb");
  if (file == nullptr) return 0;
  std::fwrite(data, 1, size, file);
  std::fclose(file);
  try {
    krater::read_scene(scene_file());
  } catch (const krater::InputError& error) {
    // What is refused has its reason; what is thrown otherwise ends the fuzzer.
    if (std::string{error.what()}.empty()) std::abort();
  }
  return 0;
}
