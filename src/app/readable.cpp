// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/readable.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

namespace krater {

namespace {

struct Step {
  const char* unit;  ///< SI
  double from;       ///< least size that it is for; of each unit rising
  double size;       ///< SI per shown unit
  const char* name;
};

constexpr Step kSteps[] = {
    {"m", 0, 1e-9, "nm"},
    {"m", 1e-7, 1e-6, "um"},
    {"m", 1e-4, 1e-3, "mm"},
    {"m", 1, 1, "m"},
    {"s", 0, 1e-9, "ns"},
    {"s", 1e-6, 1e-6, "us"},
    {"s", 1e-3, 1e-3, "ms"},
    {"s", 1, 1, "s"},
    {"kg", 0, 1e-9, "ug"},
    {"kg", 1e-6, 1e-6, "mg"},
    {"kg", 1e-3, 1e-3, "g"},
    {"kg", 1, 1, "kg"},
    {"m/s", 0, 1, "m/s"},
    {"m/s", 2e3, 1e3, "km/s"},
    {"kg/m^3", 0, 1, "kg/m^3"},
    {"kg/m^3", 100, 1e3, "g/cm^3"},
    {"J/kg", 0, 1, "J/kg"},
    {"J/kg", 1e3, 1e3, "kJ/kg"},
    {"J/kg", 1e6, 1e6, "MJ/kg"},
    {"m/s^2", 0, 1, "m/s^2"},
    {"m/s^2", 1e3, 1e3, "km/s^2"},
    {"m/s^2", 1e6, 1e6, "Mm/s^2"},
    {"m^2", 0, 1e-6, "mm^2"},
    {"m^2", 1, 1, "m^2"},
    {"m^3", 0, 1e-9, "mm^3"},
    {"m^3", 1e-6, 1e-6, "cm^3"},
    {"m^3", 1, 1, "m^3"},
    {"rad", 0, std::numbers::pi / 180, "degree"},
    {"1", 0, 1, ""},
    {"", 0, 1, ""},
};
constexpr Step kUsual[] = {{"m", 0, 1e-3, "mm"}, {"s", 0, 1e-6, "us"}, {"kg", 0, 1e-3, "g"}};

constexpr std::array<std::string_view, 6> kPrefixed{"J", "Pa", "N", "W", "N s", "Hz"};
constexpr Step kPrefixes[] = {{"", 0, 1e-9, "n"}, {"", 1e-6, 1e-6, "u"}, {"", 1e-3, 1e-3, "m"},
                              {"", 1, 1, ""},     {"", 1e3, 1e3, "k"},   {"", 1e6, 1e6, "M"},
                              {"", 1e9, 1e9, "G"}};
constexpr double kRounding = 1 - 1e-9;

}  // namespace

ShownUnit shown_unit(double largest, const std::string& unit) {
  largest = std::abs(largest);
  const bool told = std::isfinite(largest) && largest > 0;
  if (!told)
    for (const Step& s : kUsual)
      if (unit == s.unit) return {s.size, s.name};
  if (!told) largest = 1;
  ShownUnit out{1, unit};
  for (const Step& s : kSteps)
    if (unit == s.unit && largest >= s.from * kRounding) out = {s.size, s.name};
  for (const std::string_view prefixed : kPrefixed)
    if (unit == prefixed)
      for (const Step& s : kPrefixes)
        if (largest >= s.from * kRounding) out = {s.size, s.name + unit};
  return out;
}

std::string readable(double value, const std::string& unit, int digits) {
  if (!std::isfinite(value)) return "-";
  const ShownUnit shown = shown_unit(value, unit);
  return fmt::format("{:.{}g}{}{}", value / shown.size, digits, shown.name.empty() ? "" : " ",
                     shown.name);
}

}  // namespace krater
