// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/scene/yaml/units.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "krater/materials/catalogue.hpp"

using krater::parse_quantity;

TEST_SUITE("unit") {
  TEST_CASE("units: decimal units give the bits of the literal") {
    struct Good {
      const char* text;
      const char* unit;
      double value;
    };
    const Good table[] = {
        {"25.4 mm", "m", 25.4e-3},
        {"190 m/s", "m/s", 190},
        {"-190 m/s", "m/s", -190},
        {"190m/s", "m/s", 190},
        {"  +190  m/s ", "m/s", 190},
        {"90 MPa", "Pa", 90e6},
        {"46 GPa", "Pa", 46e9},
        {"1 g/cm^3", "kg/m^3", 1000},
        {"7.85 g/cm3", "kg/m^3", 7850},
        {"8.93 Mg m^-3", "kg/m^3", 8930},
        {"7.85e-9 t/mm^3", "kg/m^3", 7850},
        {"80 us", "s", 80e-6},
        {"80 \xc2\xb5s", "s", 80e-6},
        {"80 \xce\xbcs", "s", 80e-6},
        {"0.3 ms", "s", 0.3e-3},
        {"1.7 ns", "s", 1.7e-9},
        {"1 Mbar", "Pa", 1e11},
        {"1 N/mm^2", "Pa", 1e6},
        {"1 N mm-2", "Pa", 1e6},
        {"383 J/(kg K)", "J/(kg K)", 383},
        {"383 J/kg/K", "J/(kg K)", 383},
        {"0.383 kJ kg^-1 K^-1", "J/(kg K)", 383},
        {"1 kg*m**2*s**-2", "J", 1},
        {"1e3 1/s", "1/s", 1e3},
        {"1e3 s^-1", "1/s", 1e3},
        {"1 kHz", "1/s", 1e3},
        {"30 %", "1", 0.3},
        {"1e3", "1", 1000},
        {"1E+3", "1", 1000},
        {".5", "1", 0.5},
        {"5.", "1", 5},
        {"010", "1", 10},
        {"1e3 mm", "m", 1},
        {"20 degC", "K", 20 + 273.15},
        {"20 \xc2\xb0"
         "C",
         "K", 20 + 273.15},
        {"294 K", "K", 294},
        {"4.9e-324", "1", 4.9e-324},
    };
    for (const Good& good : table) {
      CAPTURE(std::string{good.text});
      const krater::QuantityText parsed = parse_quantity(good.text, good.unit);
      CHECK(parsed.problem == "");
      CHECK(parsed.value == good.value);
    }
  }

  TEST_CASE("units: other factors come from UDUNITS") {
    CHECK(parse_quantity("1 in", "m").value == doctest::Approx(0.0254).epsilon(1e-15));
    CHECK(parse_quantity("36 km/h", "m/s").value == doctest::Approx(10).epsilon(1e-15));
    CHECK(parse_quantity("1 psi", "Pa").value == doctest::Approx(6894.757293168).epsilon(1e-10));
    CHECK(parse_quantity("2 min", "s").value == doctest::Approx(120).epsilon(1e-15));
    CHECK(parse_quantity("180 degree", "1").value ==
          doctest::Approx(3.14159265358979).epsilon(1e-14));
  }

  TEST_CASE("units: traps and nonsense are refused with a hint") {
    const char* const table[][3] = {
        {"90 MPA", "Pa", "did you mean MPa"},
        {"90 Mpa", "Pa", "MPa"},
        {"90 gpa", "Pa", "GPa"},
        {"5 KG", "kg", "did you mean kg"},
        {"20 C", "K", "degC"},
        {"20 deg", "K", "degC"},
        {"20 degF", "K", "K or degC"},
        {"20 degC", "Pa", "wrong dimension"},
        {"383 J/kg K", "J/(kg K)", "J/(kg K) or J/kg/K"},
        {"383 J/kg*K", "J/(kg K)", "ambiguous"},
        {"383 J/(kg degC)", "J/(kg K)", "per degree is /K"},
        {"3 T", "kg", "tonne is t"},
        {"3 e", "1", "unknown unit 'e'"},
        {"3 u", "kg", "unknown unit"},
        {"3 mm @ 5", "m", "unknown unit"},
        {"3 second", "s", "write s"},
        {"80 microseconds", "s", "write us"},
        {"0.5 Millimeters", "m", "write mm"},
        {"90 megapascals", "Pa", "write MPa"},
        {"3 mm\xc2\xb3", "m^3", "written m^2, m^3"},
        {"2*10^-6", "s", "written with e"},
        {"2 x 10-6 s", "s", "written with e"},
        {"2\xc3\x97"
         "10-6 s",
         "s", "written with e"},
        {"10 mm; 30 mm", "m", "with commas"},
        {"3 \xe2\x80\x93 5", "1", "typographic minus"},
        {"3 sec", "s", "write s"},
        {"3 /s", "1/s", "write 1/s"},
        {"3 m/s", "m", "wrong dimension: expected a value in m"},
        {"3 m", "1", "expected a pure number"},
        {"1_000", "1", "without separators"},
        {"1,5", "1", "decimal point"},
        {"1.2.3", "1", "two decimal points"},
        {"0x10", "1", "not a decimal number"},
        {"1d3", "1", "written with e"},
        {".nan", "1", "not a finite number"},
        {"-.inf", "1", "not a finite number"},
        {"NaN", "1", "not a finite number"},
        {"1e400", "1", "outside the range"},
        {"1e99999999999999999999", "1", "outside the range"},
        {"1e300 GPa", "Pa", "outside the range"},
        {"\xe2\x88\x92"
         "5",
         "1", "typographic minus"},
        {"", "m", "is empty"},
        {".", "m", "is not a number"},
        {"-", "m", "is not a number"},
        {"mm", "m", "is not a number"},
        {"3 (m", "m", "missing ')'"},
        {"3 m)", "m", "unexpected"},
        {"3 m^", "m", "exponent"},
        {"3 m^12", "m", "exponent"},
        {"3 m^0", "m", "exponent"},
        {"3 ()", "m", "expected a unit"},
        {"3 ((((((m))))))", "m", "brackets"},
        {"3 m//s", "m/s", "expected a unit"},
        {"true", "1", "is not a number"},
    };
    for (const auto& row : table) {
      CAPTURE(std::string{row[0]});
      const std::string problem = parse_quantity(row[0], row[1]).problem;
      CHECK_MESSAGE(problem.find(row[2]) != std::string::npos, problem);
    }
  }

  TEST_CASE("units: numbers and expressions are told apart") {
    for (const char* text : {"\xe2\x88\x92"
                             "190 m/s",
                             "1", "-190 m/s", "1 1/s", "3 q", "1e3", ".5 mm"})
      CHECK(krater::looks_like_quantity(text));
    for (const char* text : {"2*x", "2 * x", "-3 - x", "x", "sin(x)", "2^x", "", "-x", "1 < x"}) {
      CHECK_FALSE(krater::looks_like_quantity(text));
    }
  }

  TEST_CASE("units: every parameter of the catalogue has a unit that UDUNITS knows") {
    for (const krater::LawInfo& law : krater::catalogue()) {
      for (const krater::ParameterInfo& info : law.parameters) {
        CAPTURE(law.name);
        CAPTURE(std::string{info.key});
        // Asks UDUNITS for the expected unit; the answer may be that the dimension is wrong.
        const krater::QuantityText parsed = parse_quantity("1 mm", info.unit);
        CHECK(std::isfinite(parsed.value));
      }
    }
  }
}
