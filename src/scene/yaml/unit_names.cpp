// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/yaml/unit_names.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "scene/yaml/problems.hpp"

namespace krater::scene {

namespace {

struct Symbol {
  const char* name;
  const char* udunits;
  int exponent;  ///< symbol = 10^exponent udunits
  bool prefixes;
};

constexpr std::array kSymbols{
    Symbol{"m", "m", 0, true},         Symbol{"g", "kg", -3, true},
    Symbol{"s", "s", 0, true},         Symbol{"K", "K", 0, true},
    Symbol{"N", "N", 0, true},         Symbol{"Pa", "Pa", 0, true},
    Symbol{"J", "J", 0, true},         Symbol{"W", "W", 0, true},
    Symbol{"Hz", "Hz", 0, true},       Symbol{"bar", "Pa", 5, true},
    Symbol{"t", "kg", 3, false},       Symbol{"erg", "J", -7, true},
    Symbol{"dyn", "N", -5, true},      Symbol{"%", "1", -2, false},
    Symbol{"rad", "radian", 0, true},  Symbol{"degree", "degree", 0, false},
    Symbol{"deg", "degree", 0, false}, Symbol{"rpm", "rpm", 0, false},
    Symbol{"min", "minute", 0, false}, Symbol{"h", "hour", 0, false},
    Symbol{"inch", "inch", 0, false},  Symbol{"in", "inch", 0, false},
    Symbol{"ft", "foot", 0, false},    Symbol{"lb", "pound", 0, false},
    Symbol{"psi", "psi", 0, false},    Symbol{"ksi", "psi", 3, false},
    Symbol{"atm", "atm", 0, false},
};

struct Prefix {
  const char* name;
  int exponent;
};

constexpr std::array kPrefixes{
    Prefix{"k", 3},         Prefix{"M", 6},  Prefix{"G", 9},   Prefix{"T", 12},
    Prefix{"c", -2},        Prefix{"m", -3}, Prefix{"u", -6},  Prefix{"\xc2\xb5", -6},
    Prefix{"\xce\xbc", -6}, Prefix{"n", -9}, Prefix{"p", -12}, Prefix{"f", -15},
    Prefix{"d", -1},
};

struct Trap {
  const char* word;
  const char* hint;
};

constexpr std::array kTraps{
    Trap{"C", "degrees Celsius are degC"},
    Trap{"c", "degrees Celsius are degC"},
    Trap{"F", "temperatures are K or degC"},
    Trap{"degF", "temperatures are K or degC"},
    Trap{"T", "a tonne is t, a temperature K; tesla is not used here"},
    Trap{"k", "kelvin is K, a prefix needs a unit"},
    Trap{"M", "metre is m, a prefix needs a unit"},
    Trap{"kelvin", "write K"},
    Trap{"Kelvin", "write K"},
    Trap{"sec", "write s"},
    Trap{"msec", "write ms"},
    Trap{"usec", "write us"},
    Trap{"micron", "write um"},
    Trap{"cc", "write cm^3"},
    Trap{"gr", "a gram is g"},
    Trap{"kgf", "force is N"},
    Trap{"lbf", "force is N"},
    Trap{"mps", "write m/s"},
    Trap{"kph", "write km/h"},
    Trap{"d", "exponents are written with e: 1e3"},
};

const Symbol* find_symbol(std::string_view name) {
  const auto found = std::find_if(kSymbols.begin(), kSymbols.end(),
                                  [&](const Symbol& s) { return name == s.name; });
  return found == kSymbols.end() ? nullptr : &*found;
}

std::string lower(std::string_view text) {
  std::string out{text};
  for (char& c : out) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return out;
}

struct Spelled {
  const char* word;
  const char* symbol;
};
constexpr std::array kSpelledUnits{
    Spelled{"second", "s"}, Spelled{"metre", "m"},   Spelled{"meter", "m"},
    Spelled{"gram", "g"},   Spelled{"pascal", "Pa"}, Spelled{"newton", "N"},
    Spelled{"joule", "J"},  Spelled{"watt", "W"},    Spelled{"hertz", "Hz"},
};
constexpr std::array kSpelledPrefixes{
    Spelled{"", ""},       Spelled{"kilo", "k"},  Spelled{"mega", "M"}, Spelled{"giga", "G"},
    Spelled{"milli", "m"}, Spelled{"micro", "u"}, Spelled{"nano", "n"}, Spelled{"centi", "c"},
};

/// The symbol of a unit that is written out: us of microseconds; empty if it is none.
std::string symbol_of(std::string word) {
  if (word.size() > 1 && word.back() == 's') word.pop_back();
  for (const Spelled& prefix : kSpelledPrefixes)
    for (const Spelled& unit : kSpelledUnits)
      if (word == std::string{prefix.word} + unit.word)
        return std::string{prefix.symbol} + unit.symbol;
  return "";
}

std::string explain_unknown(std::string_view word) {
  const std::string start = "unknown unit " + quote(word);
  if (const std::string symbol = symbol_of(lower(word)); !symbol.empty())
    return start + " (write " + symbol + ")";
  for (const char* raised : {"\xc2\xb2", "\xc2\xb3"})
    if (word.find(raised) != std::string_view::npos)
      return start + " (exponents are written m^2, m^3)";
  for (const Trap& trap : kTraps) {
    if (word == trap.word) return start + " (" + trap.hint + ")";
  }
  std::vector<std::string> near;
  for (const Symbol& symbol : kSymbols) {
    if (lower(word) == lower(symbol.name)) near.emplace_back(symbol.name);
    for (const Prefix& prefix : kPrefixes) {
      const std::string name = std::string{prefix.name} + symbol.name;
      if (symbol.prefixes && lower(word) == lower(name)) near.push_back(name);
    }
  }
  if (!near.empty()) {
    std::string words = near[0];
    for (std::size_t i = 1; i < near.size(); ++i) words += " or " + near[i];
    return start + " (did you mean " + words + "?)";
  }
  std::vector<std::string> known;
  for (const Symbol& symbol : kSymbols) known.emplace_back(symbol.name);
  return start + " (known, with prefixes like k, M, G, m, u: " + join(known) + ", degC)";
}

/// Recursive descent over the unit expression. `sign`: +1 in a numerator, -1 in a denominator.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_{text} {}

  UnitText parse() {
    product(1, 0);
    if (result_.problem.empty() && at_ < text_.size())
      fail("unexpected " + quote(text_.substr(at_)));
    if (result_.udunits.empty()) result_.udunits = "1";
    return result_;
  }

 private:
  bool failed() const { return !result_.problem.empty(); }
  void fail(const std::string& problem) {
    if (!failed()) result_.problem = problem;
  }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_blanks() {
    while (peek() == ' ' || peek() == '\t') ++at_;
  }

  void product(int power, int depth) {
    if (depth > 4) return fail("too many brackets in a unit");
    bool divided = false;
    factor(power, depth);
    while (!failed()) {
      skip_blanks();
      const char c = peek();
      if (c == '\0' || c == ')') return;
      const bool slash = c == '/';
      if (slash || c == '.' || (c == '*' && text_.substr(at_, 2) != "**")) ++at_;
      // UDUNITS would read J/kg K as (J/kg) K; people mean J/(kg K).
      if (divided && !slash)
        return fail("a product after a division is ambiguous; write J/(kg K) or J/kg/K");
      divided = slash;
      skip_blanks();
      factor(slash ? -power : power, depth);
      divided = divided || slash;
    }
  }

  void factor(int power, int depth) {
    if (peek() == '(') {
      ++at_;
      skip_blanks();
      const std::size_t close = closing_bracket();
      if (close == std::string_view::npos) return fail("missing ')' in the unit");
      // The exponent stands behind the bracket but is needed inside it.
      const std::size_t inside = at_;
      at_ = close + 1;
      const int exponent = read_exponent();
      const std::size_t after = at_;
      at_ = inside;
      if (failed()) return;
      product(power * exponent, depth + 1);
      skip_blanks();
      if (!failed() && at_ != close) return fail("misplaced bracket in the unit");
      at_ = after;
      return;
    }
    if (peek() == '1') {
      ++at_;
      return;
    }
    const std::string_view word = read_word();
    if (word.empty()) return fail("expected a unit at " + quote(text_.substr(at_)));
    symbol(word, power);
  }

  void symbol(std::string_view word, int power) {
    if (is_celsius(word))
      return fail("degrees Celsius only for a temperature by itself; per degree is /K");
    const Symbol* base = find_symbol(word);
    int exponent = base ? base->exponent : 0;
    for (const Prefix& prefix : kPrefixes) {
      const std::string_view name{prefix.name};
      if (base || word.substr(0, name.size()) != name) continue;
      const Symbol* rest = find_symbol(word.substr(name.size()));
      if (rest && rest->prefixes) {
        base = rest;
        exponent = rest->exponent + prefix.exponent;
      }
    }
    if (!base) return fail(explain_unknown(word));
    const int total = power * read_exponent();
    if (failed()) return;
    result_.exponent += long{exponent} * total;
    if (std::string_view{base->udunits} == "1") return;
    result_.udunits +=
        (result_.udunits.empty() ? "" : ".") + std::string{base->udunits} + std::to_string(total);
  }

  std::string_view read_word() {
    const std::size_t start = at_;
    const auto in_word = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || c == '_' || c == '@' ||
             c == '"' || (static_cast<unsigned char>(c) >= 0x80);
    };
    while (at_ < text_.size() && in_word(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
  }

  int read_exponent() {
    bool marked = false;
    if (text_.substr(at_, 2) == "**") {
      at_ += 2;
      marked = true;
    } else if (peek() == '^') {
      ++at_;
      marked = true;
    }
    int sign = 1;
    if (peek() == '-' || peek() == '+') {
      sign = peek() == '-' ? -1 : 1;
      ++at_;
      marked = true;
    }
    const char c = peek();
    if (c < '1' || c > '9') {
      if (marked) fail("an exponent must be a whole number from 1 to 9");
      return 1;
    }
    ++at_;
    if ((peek() >= '0' && peek() <= '9')) fail("an exponent must be a whole number from 1 to 9");
    return sign * (c - '0');
  }

  std::size_t closing_bracket() const {
    int open = 1;
    for (std::size_t i = at_; i < text_.size(); ++i) {
      if (text_[i] == '(') ++open;
      if (text_[i] == ')' && --open == 0) return i;
    }
    return std::string_view::npos;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  UnitText result_;
};

}  // namespace

UnitText parse_unit(std::string_view text) { return Parser{text}.parse(); }

bool is_celsius(std::string_view text) {
  return text == "degC" || text == "celsius" ||
         text ==
             "\xc2\xb0"
             "C";
}

}  // namespace krater::scene
