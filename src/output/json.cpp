// SPDX-License-Identifier: GPL-3.0-or-later
// Text of Json values (RFC 8259). Doubles are written with the fewest digits that read back
// exactly.
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "krater/output/results.hpp"

namespace krater {
namespace {

/// Length of the valid UTF-8 sequence at `at` (1 to 4), or 0. Overlong forms and surrogates are
/// not.
std::size_t utf8_length(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
  };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return 0;
  }
  const bool wrong = (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
                     (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F);
  return wrong ? 0 : length;
}

std::string escape(char c) {
  switch (c) {
    case '"':
      return "\\\"";
    case '\\':
      return "\\\\";
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      break;
  }
  std::array<char, 8> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "\\u%04x", static_cast<unsigned>(c));
  return buffer.data();
}

/// Text in quotes. Bytes that are no UTF-8 (a file name, say) become U+FFFD: the file stays
/// readable.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const char c = text[i];
    if (length == 0) {
      result += "\\ufffd";
      i += 1;
    } else if (length == 1 && (static_cast<unsigned char>(c) < 0x20 || c == '"' || c == '\\')) {
      result += escape(c);
      i += 1;
    } else {
      result.append(text, i, length);
      i += length;
    }
  }
  return result + '"';
}

std::string number_text(double x) {
  if (!std::isfinite(x)) return "null";
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr;
  std::string text(buffer.data(), end);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";  // stays a float when read
  return text;
}

std::string indented_text(const Json& json, const std::string& indent) {
  const std::string inner = indent + "  ";
  std::string result;
  switch (json.kind) {
    case Json::Kind::number:
      return number_text(json.number);
    case Json::Kind::integer:
      return std::to_string(json.integer);
    case Json::Kind::text:
      return quoted(json.text);
    case Json::Kind::boolean:
      return json.flag ? "true" : "false";
    case Json::Kind::null:
      return "null";
    case Json::Kind::array:
      for (const auto& item : json.items) {
        result += (result.empty() ? "\n" : ",\n") + inner + indented_text(item, inner);
      }
      return result.empty() ? "[]" : "[" + result + "\n" + indent + "]";
    case Json::Kind::object:
      break;
  }
  for (std::size_t i = 0; i < json.items.size(); ++i) {
    result += (result.empty() ? "\n" : ",\n") + inner + quoted(json.keys[i]) + ": " +
              indented_text(json.items[i], inner);
  }
  return result.empty() ? "{}" : "{" + result + "\n" + indent + "}";
}

}  // namespace

Json Json::of(double x) {
  Json json;
  json.kind = Kind::number;
  json.number = x;
  return json;
}

Json Json::of(bool b) {
  Json json;
  json.kind = Kind::boolean;
  json.flag = b;
  return json;
}

Json Json::of(std::string s) {
  Json json;
  json.kind = Kind::text;
  json.text = std::move(s);
  return json;
}

Json Json::of(const char* s) { return of(std::string(s)); }

Json Json::of_integer(std::int64_t i) {
  Json json;
  json.kind = Kind::integer;
  json.integer = i;
  return json;
}

Json Json::array() {
  Json json;
  json.kind = Kind::array;
  return json;
}

Json Json::null() {
  Json json;
  json.kind = Kind::null;
  return json;
}

Json& Json::operator[](const std::string& key) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == key) return items[i];
  }
  keys.push_back(key);
  return items.emplace_back();
}

std::string to_text(const Json& json) { return indented_text(json, "") + "\n"; }

}  // namespace krater
