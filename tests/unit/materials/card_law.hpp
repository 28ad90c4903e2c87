// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The law of a material as the program reads it: from a card, or from a block of YAML.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "krater/core/errors.hpp"
#include "krater/materials/law_list.hpp"
#include "krater/scene/point.hpp"

namespace krater::test {

/// `material`: flow YAML without braces, as "density: 2400, model: {...}".
inline MaterialOptions read_one_material(const std::string& material) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("krater_card_" + std::to_string(getpid()) + ".yaml");
  std::ofstream{file}
      << "materials: {m: {" << material << "}}\n"
      << "point: {path: {uniaxial_stress: {strain: 1e-3, rate: 1}}, length: 1 mm}\n";
  struct Remover {
    const std::filesystem::path& file;
    ~Remover() { std::filesystem::remove(file); }
  } remover{file};
  return read_point(file.string()).material;
}
template <class Law>
Law law_of(const std::string& material) {
  const MaterialOptions m = read_one_material(material);
  return make_law<Law>(m.model->values.data(), {m.density, m.shear_modulus, m.initial_temperature});
}
template <class Law>
Law law_of_card(const std::string& card, const std::string& more = "") {
  return law_of<Law>("card: " + std::string{KRATER_SOURCE_DIR} + "/inputs/materials/" + card +
                     ".yaml" + (more.empty() ? "" : ", " + more));
}

}  // namespace krater::test
