// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/scene/yaml/units.hpp"

#include <udunits2.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "scene/yaml/problems.hpp"
#include "scene/yaml/unit_names.hpp"

namespace krater {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// A decimal number split so that its exponent can be changed without rounding.
struct Decimal {
  std::string mantissa;  ///< sign, digits and point
  long exponent = 0;
  std::size_t length = 0;  ///< characters read; 0: not a number
};

Decimal read_decimal(std::string_view text) {
  Decimal number;
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) {
    if (text[i] == '-') number.mantissa = "-";
    ++i;
  }
  bool digits = false;
  bool point = false;
  for (; i < text.size() && (is_digit(text[i]) || (text[i] == '.' && !point)); ++i) {
    digits = digits || is_digit(text[i]);
    point = point || text[i] == '.';
    number.mantissa += text[i];
  }
  if (!digits) return {};
  std::size_t e = i;
  if (e < text.size() && (text[e] == 'e' || text[e] == 'E')) {
    ++e;
    if (e < text.size() && text[e] == '+') ++e;
    const char* begin = text.data() + e;
    const auto result = std::from_chars(begin, text.data() + text.size(), number.exponent);
    if (result.ec != std::errc::invalid_argument) {
      i = static_cast<std::size_t>(result.ptr - text.data());
      // Beyond any double, but safe to add a prefix to.
      if (result.ec != std::errc{} || std::labs(number.exponent) > 100000) number.exponent = 100000;
    }
  }
  number.length = i;
  return number;
}

/// Nearest double to mantissa * 10^(exponent + shift), or nothing where it does not fit.
std::optional<double> to_double(const Decimal& number, long shift) {
  const std::string text = number.mantissa + "e" + std::to_string(number.exponent + shift);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{}) return std::nullopt;
  return value;
}

class UnitSystem {
 public:
  static UnitSystem& instance() {
    static UnitSystem system;
    return system;
  }

  /// Factor from `from` to `to`, or nothing where the dimensions differ.
  std::optional<double> factor(const std::string& from, const std::string& to) {
    const auto key = std::make_pair(from, to);
    if (const auto known = factors_.find(key); known != factors_.end()) return known->second;
    const Unit source = parse(from);
    const Unit target = parse(to);
    std::optional<double> result;
    if (ut_are_convertible(source.get(), target.get()) != 0) {
      const std::unique_ptr<cv_converter, decltype(&cv_free)> converter{
          ut_get_converter(source.get(), target.get()), &cv_free};
      if (converter) result = cv_convert_double(converter.get(), 1.0);
    }
    return factors_[key] = result;
  }

 private:
  using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;

  UnitSystem() {
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    if (!system_)
      throw std::runtime_error(
          "UDUNITS-2 cannot read its table of units (is libudunits2-data installed?)");
  }

  Unit parse(const std::string& text) const {
    Unit unit{ut_parse(system_.get(), text.c_str(), UT_UTF8), &ut_free};
    if (!unit) throw std::logic_error("UDUNITS-2 does not know the unit '" + text + "'");
    return unit;
  }

  std::unique_ptr<ut_system, decltype(&ut_free_system)> system_{nullptr, &ut_free_system};
  std::map<std::pair<std::string, std::string>, std::optional<double>> factors_;
};

std::string expectation(const char* unit) {
  const std::string name = unit;
  return name == "1" ? "expected a pure number" : "expected a value in " + name;
}

/// The signs minus and en dash of texts; a scene's minus is a hyphen.
bool has_typographic_minus(std::string_view text) {
  return text.find("\xe2\x88\x92") != std::string_view::npos ||
         text.find("\xe2\x80\x93") != std::string_view::npos;
}
constexpr const char* kTypographicMinus = " contains a typographic minus sign; write a hyphen";

std::string explain_no_number(std::string_view text, const char* unit) {
  using scene::quote;
  if (text.empty()) return "is empty; " + expectation(unit);
  if (has_typographic_minus(text)) return quote(text) + kTypographicMinus;
  std::string word;
  for (char c : text) {
    if (c != '.' && c != '+' && c != '-')
      word += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  }
  if (word == "nan" || word == "inf" || word == "infinity")
    return quote(text) + " is not a finite number";
  return quote(text) + " is not a number; " + expectation(unit);
}

/// A hint where the text after the number is no unit but a broken number.
std::string explain_tail(std::string_view text, std::string_view tail) {
  using scene::quote;
  if (tail.front() == '_' || tail.front() == ',' || tail.front() == '\'') {
    return quote(text) + " is not a number: write digits without separators and a decimal point";
  }
  if (has_typographic_minus(tail)) return quote(text) + kTypographicMinus;
  if (tail.find(';') != std::string_view::npos)
    return quote(text) + ": a list is written [a, b], with commas";
  const bool times = tail.front() == '*' || tail.front() == 'x' || tail.substr(0, 2) == "\xc3\x97";
  if (times && tail.find("10") != std::string_view::npos && text[0] != '0') {
    return quote(text) + ": powers of ten are written with e, 2e-6, and the unit behind";
  }
  if (tail.front() == '.') return quote(text) + " is not a number: two decimal points";
  if (tail.front() == '/') return quote(text) + ": write 1/s or s^-1, not a leading slash";
  if (tail.size() > 1 && (tail[0] == 'x' || tail[0] == 'X') && text[0] == '0') {
    return quote(text) + " is not a decimal number";
  }
  return "";
}

}  // namespace

QuantityText parse_quantity(std::string_view text, const char* unit) {
  using scene::quote;
  text = trim(text);
  const Decimal number = read_decimal(text);
  if (number.length == 0) return {0, explain_no_number(text, unit)};
  const std::string_view tail = trim(text.substr(number.length));
  const std::string out_of_range = quote(text) + " is outside the range of a number";
  if (tail.empty()) {
    const std::optional<double> value = to_double(number, 0);
    return value ? QuantityText{*value, ""} : QuantityText{0, out_of_range};
  }
  if (const std::string broken = explain_tail(text, tail); !broken.empty()) return {0, broken};
  if (scene::is_celsius(tail)) {
    if (std::string_view{unit} != "K")
      return {0, quote(text) + " has the wrong dimension: " + expectation(unit)};
    const std::optional<double> celsius = to_double(number, 0);
    return celsius ? QuantityText{*celsius + 273.15, ""} : QuantityText{0, out_of_range};
  }
  const scene::UnitText parsed = scene::parse_unit(tail);
  if (!parsed.problem.empty()) return {0, quote(text) + ": " + parsed.problem};
  const std::optional<double> factor = UnitSystem::instance().factor(parsed.udunits, unit);
  if (!factor) {
    const bool degrees = std::string_view{unit} == "K" && tail.starts_with("deg");
    return {0, quote(text) + " has the wrong dimension: " + expectation(unit) +
                   (degrees ? "; degrees Celsius are degC" : "")};
  }
  const std::optional<double> value = to_double(number, parsed.exponent);
  // UDUNITS may find a factor of 1 by a detour that costs a last bit.
  const bool decimal = std::abs(*factor - 1) < 1e-14;
  const double scaled = value ? (decimal ? *value : *value * *factor) : 0;
  if (!value || !std::isfinite(scaled)) return {0, out_of_range};
  return {scaled, ""};
}

bool looks_like_quantity(std::string_view text) {
  text = trim(text);
  if (has_typographic_minus(text)) return true;
  const Decimal number = read_decimal(text);
  if (number.length == 0) return false;
  const std::string_view tail = trim(text.substr(number.length));
  return tail.empty() ||
         std::string_view{"+-*/^(<>=!&|?:,"}.find(tail.front()) == std::string_view::npos;
}

}  // namespace krater
