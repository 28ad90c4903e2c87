// SPDX-License-Identifier: GPL-3.0-or-later
// Target of libFuzzer (tools/fuzz scene): any bytes are a scene file that is read, or refused by
// name.
#include "fuzz/fuzz_file.hpp"
#include "krater/core/errors.hpp"
#include "krater/scene/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const krater::fuzz::MemoryFile file{"yaml"};
  if (!file.write(data, size)) return 0;
  try {
    krater::read_scene(file.path());
  } catch (const krater::InputError& error) {
    krater::fuzz::require_reason(error);
  }
  return 0;
}
