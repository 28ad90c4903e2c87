// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/readers/elastic_constants.hpp"

#include <string>

#include "scene/yaml/block.hpp"

namespace krater::scene {

namespace {}  // namespace

ElasticConstants read_elastic_constants(Block& material) {
  const std::size_t before = material.problems().size();
  const std::optional<double> G = material.optional_number("shear_modulus");
  const std::optional<double> K = material.optional_number("bulk_modulus");
  const std::optional<double> E = material.optional_number("youngs_modulus");
  const std::optional<double> nu = material.optional_number("poisson_ratio");
  const int given = (G ? 1 : 0) + (K ? 1 : 0) + (E ? 1 : 0) + (nu ? 1 : 0);
  ElasticConstants result;
  result.shear = G.value_or(0.0);
  result.bulk = K;
  result.bulk_given = K && given == 1;
  // What is wrong with the constants is said once, not again by the laws that miss them.
  const auto broken = [&] { return material.problems().size() > before; };
  result.known = false;
  if (broken()) return result;
  if (nu && !(*nu > -1 && *nu < 0.5)) {
    material.fail("poisson_ratio must lie between -1 and 0.5");
    return result;
  }
  if (given > 2) {
    material.fail(
        "at most two of shear_modulus, bulk_modulus, youngs_modulus and poisson_ratio can be "
        "given");
    return result;
  }
  if (given == 1 && (E || nu)) {
    material.fail(
        "youngs_modulus and poisson_ratio go together (or one of them with shear_modulus or "
        "bulk_modulus)");
    return result;
  }
  result.known = true;
  if (given < 2) return result;
  if (E && nu) {
    result.shear = *E / (2 * (1 + *nu));
    result.bulk = *E / (3 * (1 - 2 * *nu));
  } else if (G && nu) {
    result.bulk = 2 * *G * (1 + *nu) / (3 * (1 - 2 * *nu));
  } else if (K && nu) {
    result.shear = 3 * *K * (1 - 2 * *nu) / (2 * (1 + *nu));
  } else if (E && G) {
    result.bulk = *E * *G / (3 * (3 * *G - *E));
  } else if (E && K) {
    result.shear = 3 * *K * *E / (9 * *K - *E);
  }
  if (!(result.shear > 0) || !(*result.bulk > 0))
    material.fail("these elastic constants belong to no stable body");
  result.known = !broken();
  return result;
}

}  // namespace krater::scene
