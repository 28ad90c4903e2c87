// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/field_doubts.hpp"

#include <algorithm>

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

}  // namespace krater
