// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/yaml/unit_names.hpp
/// The unit expressions that a scene may use: symbols of a short list with decimal prefixes, powers
/// (`m^2`, `mm2`, `s-1`), products (space, `*`, `.`), quotients and brackets.
#include <string>
#include <string_view>

namespace krater::scene {

/// unit = 10^exponent * udunits
struct UnitText {
  long exponent = 0;    ///< decimal prefixes, and units that are powers of ten of an SI unit
  std::string udunits;  ///< the rest, in UDUNITS spelling
  std::string problem;  ///< empty: none
};

UnitText parse_unit(std::string_view text);

/// Celsius has an offset and is therefore no factor: handled apart.
bool is_celsius(std::string_view text);

}  // namespace krater::scene
