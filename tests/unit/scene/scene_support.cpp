// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_support.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <iterator>
#include <sstream>

#include "krater/core/errors.hpp"

namespace krater::test {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
  static std::atomic<int> count{0};
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  path_ = fs::temp_directory_path() /
          ("krater_scene_" + std::to_string(now) + "_" + std::to_string(count++));
  fs::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

std::string ScratchFolder::write(const std::string& name, const std::string& text) const {
  const fs::path file = path_ / name;
  fs::create_directories(file.parent_path());
  std::ofstream{file, std::ios::binary} << text;
  return file.string();
}

const std::string& small_scene() {
  static const std::string text = R"(title: small
frame: axisymmetric
grid:
  cell: 1 mm
  box: {min: [0, 0], max: [10 mm, 20 mm]}
  boundary:
    z_min: wall
    r_min: axis
time: {end: 10 us, cfl: 0.5}
method:
  shape: quadratic_bspline
  transfer: tflip
materials:
  steel:
    density: 7850
    shear_modulus: 80 GPa
    eos: {linear: {bulk_modulus: 160 GPa}}
    strength:
      von_mises: {Y: 400 MPa, H: 100 MPa}
    viscosity: {q_lin: 0.3}
bodies:
  rod:
    material: steel
    shape: {cylinder: {radius: 3 mm, height: 12 mm}}
    velocity: [0, -100 m/s]
output: {frames: 1 us, fields: [pressure]}
measures:
  length: {kind: extent, body: rod, axis: z}
  foot: {kind: diameter, body: rod, at: {z: 0}}
references:
  length: {value: 11 mm, source: guess}
)";
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, "no '", from, "' in the scene");
  return text.replace(at, from.size(), to);
}

int line_of(const std::string& text, const std::string& part) {
  std::istringstream stream(text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.find(part) != std::string::npos) return number;
  }
  return 0;
}

std::string slurp(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string message_of(const std::string& file, const std::vector<std::string>& overrides) {
  try {
    read_scene(file, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string source_path(const std::string& relative) {
  return std::string{KRATER_SOURCE_DIR} + "/" + relative;
}

}  // namespace krater::test
