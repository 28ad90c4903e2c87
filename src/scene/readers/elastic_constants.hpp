// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/readers/elastic_constants.hpp
/// Any two of Young's modulus, Poisson's ratio, shear and bulk modulus of an isotropic elastic body
/// give the others.
#include <optional>

namespace krater::scene {

class Block;

struct ElasticConstants {
  double shear = 0;            ///< G [Pa]; 0: none given, a fluid
  std::optional<double> bulk;  ///< K [Pa], where known
  bool bulk_given = false;     ///< by its own key, so that somebody must use it
  bool bulk_used = false;
  bool known = true;  ///< false: they were given and refused
};

/// Reads shear_modulus, bulk_modulus, youngs_modulus and poisson_ratio from a material's block.
ElasticConstants read_elastic_constants(Block& material);

}  // namespace krater::scene
