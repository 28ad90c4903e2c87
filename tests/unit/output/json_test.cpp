// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "krater/output/results.hpp"

using namespace krater;

TEST_SUITE("unit") {
  TEST_CASE("json: objects keep their order, nest and are indented") {
    Json json;
    json["b"] = Json::of(1);
    json["a"]["inner"] = Json::of(true);
    json["list"] = Json::array();
    json["list"].items = {Json::of("x"), Json::null()};
    json["empty"];
    json["b"] = Json::of(std::size_t{2});  // replaced in place
    CHECK(to_text(json) ==
          "{\n  \"b\": 2,\n  \"a\": {\n    \"inner\": true\n  },\n"
          "  \"list\": [\n    \"x\",\n    null\n  ],\n  \"empty\": {}\n}\n");
  }

  TEST_CASE("json: strings are escaped, and what is no UTF-8 is replaced") {
    const auto text = [](const std::string& s) { return to_text(Json::of(s)); };
    CHECK(text("say \"hi\" \\ \n\t\r") == "\"say \\\"hi\\\" \\\\ \\n\\t\\r\"\n");
    CHECK(text(std::string("\x00\x01\x1f", 3)) == "\"\\u0000\\u0001\\u001f\"\n");
    CHECK(text("\x7f") == "\"\x7f\"\n");
    CHECK(text("\xc3\xa9 \xe2\x82\xac \xf0\x9f\x92\xa5") ==
          "\"\xc3\xa9 \xe2\x82\xac \xf0\x9f\x92\xa5\"\n");
    CHECK(text("a\xffz") == "\"a\\ufffdz\"\n");
    CHECK(text("\xc3") == "\"\\ufffd\"\n");                        // cut off
    CHECK(text("\xc0\xaf") == "\"\\ufffd\\ufffd\"\n");             // overlong
    CHECK(text("\xed\xa0\x80") == "\"\\ufffd\\ufffd\\ufffd\"\n");  // surrogate
    Json json;
    json["a\"b"] = Json::of(false);
    CHECK(to_text(json) == "{\n  \"a\\\"b\": false\n}\n");
  }

  TEST_CASE("json: numbers read back exactly, stay floats, and are null when not finite") {
    for (const double x : {0.1, 1.0 / 3, 1e-320, 1.7976931348623157e308, -0.0, 16.205e-3}) {
      const std::string text = to_text(Json::of(x));
      CHECK(std::strtod(text.c_str(), nullptr) == x);
      CHECK(std::signbit(std::strtod(text.c_str(), nullptr)) == std::signbit(x));
    }
    CHECK(to_text(Json::of(2.0)) == "2.0\n");
    CHECK(to_text(Json::of(2)) == "2\n");
    CHECK(to_text(Json::of(std::int64_t{-9223372036854775807 - 1})) == "-9223372036854775808\n");
    CHECK(to_text(Json::of(std::nan(""))) == "null\n");
    CHECK(to_text(Json::of(-std::numeric_limits<double>::infinity())) == "null\n");
    CHECK(to_text(Json::of("text")) == "\"text\"\n");  // not a boolean
  }
}
