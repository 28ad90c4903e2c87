// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/field_doubts.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace krater {

namespace {

constexpr double kUnlike = 10;  // ratio of densities; tungsten on aluminium is 7

}  // namespace

std::vector<std::string> doubt_fields(const Scene& scene) {
  std::vector<std::string> doubts;
  // With contact, or on a fixed reference, every body has a field of its own.
  if (scene.contact.active || scene.method.reference != Reference::current) return doubts;
  for (std::size_t a = 0; a < scene.bodies.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const auto density = [&](std::size_t body) {
        return scene.materials[static_cast<std::size_t>(scene.bodies[body].material)].density;
      };
      const auto [light, heavy] =
          std::minmax(a, b, [&](std::size_t i, std::size_t j) { return density(i) < density(j); });
      if (density(heavy) < kUnlike * density(light)) continue;
      doubts.push_back(fmt::format(
          "{} ({:g} kg/m^3) and {} ({:g} kg/m^3) share one velocity field: where they meet the "
          "heavy one drags and strains the light one; contact: {{}} lets each move by itself",
          scene.bodies[light].name, density(light), scene.bodies[heavy].name, density(heavy)));
    }
  return doubts;
}

std::vector<std::string> doubt_method(const Scene& scene) {
  std::vector<std::string> doubts;
  const auto none = [&scene](auto has) {
    return std::none_of(scene.bodies.begin(), scene.bodies.end(), has);
  };
  if (!none([](const BodyOptions& body) { return body.material_points(); })) return doubts;
  const bool elements = none([](const BodyOptions& body) { return body.sph.has_value(); });
  const MethodOptions &m = scene.method, usual;
  const std::pair<const char*, bool> keys[] = {
      {"shape", m.shape != usual.shape},
      {"transfer", m.transfer != usual.transfer},
      {"update", m.update != usual.update},
      {"points_per_direction", elements && m.points_per_direction != usual.points_per_direction},
      {"stagger", m.stagger != usual.stagger},
      {"jitter", elements && m.jitter != usual.jitter},
      {"seed", elements && m.seed != usual.seed},
      {"cell_averaging", m.cell_averaging != usual.cell_averaging},
      {"grid_pressure", m.grid_pressure != usual.grid_pressure},
      {"flip_fraction", m.flip_fraction != usual.flip_fraction},
      {"dormant_blocks", m.dormant_blocks != usual.dormant_blocks}};
  for (const auto& [key, given] : keys)
    if (given)
      doubts.push_back(
          fmt::format("method.{} says how points and grid exchange, and every body of this scene "
                      "has {}: it changes nothing",
                      key, elements ? "elements" : "particles of its own"));
  if (elements && scene.contact.active && scene.contact.normal != ContactOptions{}.normal)
    doubts.emplace_back(
        "contact.normal says how the normal is found between bodies of points; elements have "
        "faces: "
        "it changes nothing");
  return doubts;
}

}  // namespace krater
