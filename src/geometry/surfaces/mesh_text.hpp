// SPDX-License-Identifier: GPL-3.0-or-later
// Words and numbers of a text file in memory, with the line they stand on.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace krater {

class MeshText {
 public:
  MeshText(const std::string& file, std::string_view text) : file_(file), text_(text) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw std::invalid_argument(file_ + ":" + std::to_string(line_) + ": " + message);
  }

  bool at_end() {
    skip(true);
    return at_ >= text_.size();
  }

  /// The next word on any line; "" at the end of the file. `#` begins a comment where asked for.
  std::string_view word(bool comments = false) {
    skip(true, comments);
    return take();
  }

  /// The next word on this line; "" at its end.
  std::string_view word_on_line(bool comments = false) {
    skip(false, comments);
    return take();
  }

  void next_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    if (at_ < text_.size()) {
      ++at_;
      ++line_;
    }
  }

  /// Whether two words are the same, capitals or not.
  static bool same(std::string_view a, std::string_view b) {
    const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&small](char x, char y) { return small(x) == small(y); });
  }

  void expect(std::string_view wanted) {
    const std::string_view found = word();
    if (!same(found, wanted)) {
      fail("expected '" + std::string(wanted) + "', found " + shown(found));
    }
  }

  double number(bool comments = false) {
    std::string_view text = word(comments);
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size()) {
      fail("expected a number, found " + shown(text));
    }
    if (!std::isfinite(value)) fail("a coordinate is not finite: " + shown(text));
    return value;
  }

  std::int64_t integer(std::string_view text) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size()) {
      fail("expected a whole number, found " + shown(text));
    }
    return value;
  }

  std::size_t offset() const { return at_; }
  std::size_t line() const { return line_; }
  std::size_t left() const { return text_.size() - at_; }

  static std::string shown(std::string_view text) {
    if (text.empty()) return "the end of the file";
    std::string out = "'";
    for (const char c : text.substr(0, 40)) out += c >= ' ' && c < 127 ? c : '?';
    return out + "'";
  }

 private:
  static bool blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

  void skip(bool lines, bool comments = false) {
    while (at_ < text_.size()) {
      if (blank(text_[at_])) {
        ++at_;
      } else if (comments && text_[at_] == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
      } else if (lines && text_[at_] == '\n') {
        ++at_;
        ++line_;
      } else {
        return;
      }
    }
  }

  std::string_view take() {
    const std::size_t first = at_;
    while (at_ < text_.size() && !blank(text_[at_]) && text_[at_] != '\n') ++at_;
    return text_.substr(first, at_ - first);
  }

  const std::string& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

}  // namespace krater
