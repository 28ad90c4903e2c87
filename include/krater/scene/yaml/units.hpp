// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/yaml/units.hpp
/// A number with a unit, as users write it, into SI: `25.4 mm`, `1 g/cm^3`, `80 us`, `20 degC`. A
/// bare number is SI. UDUNITS-2 knows dimensions and the factors of units that are not decimal;
/// decimal prefixes are folded into the decimal exponent before the text becomes binary, so that
/// `80 us` and `80e-6` are the same bits. Assumption: units are a short list on purpose. UDUNITS
/// alone would read `T` as tesla, `e` as a charge and `J/kg K` as (J/kg) K; here these are refused
/// with a hint. One thread at a time (UDUNITS keeps global state).
#include <string>
#include <string_view>

namespace krater {

/// Value in SI, or what is wrong with the text (`problem` empty: nothing).
struct QuantityText {
  double value = 0;
  std::string problem;
};

/// `unit`: the expected dimension as SI unit in UDUNITS spelling, "1" for a pure number. Degrees
/// Celsius are accepted where the expected unit is "K".
QuantityText parse_quantity(std::string_view text, const char* unit);

/// Does the text begin as a number, alone or followed by a unit, rather than as an expression like
/// `2*x`?
bool looks_like_quantity(std::string_view text);

}  // namespace krater
