// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/meshes/mesh_lines.hpp
/// Decks of keywords and data lines, Abaqus's and LS-DYNA's: `*WORD` begins a block.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/surfaces/mesh_text.hpp"

namespace krater {

inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

inline std::string upper(std::string_view text) {
  std::string out{text};
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 32);
  return out;
}

class MeshLines {
 public:
  /// `comment`: lines that begin so are passed over.
  MeshLines(const std::string& file, std::string_view text, std::string_view comment)
      : file_{file}, text_{text}, comment_{comment} {}

  [[noreturn]] void fail(const std::string& message) const {
    throw std::invalid_argument(file_ + ":" + std::to_string(line_) + ": " + message);
  }

  /// To the next line; false at the end of the file.
  bool next() {
    do {
      if (at_ >= text_.size()) return false;
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      now_ = text_.substr(at_, end - at_);
      if (now_.ends_with('\r')) now_.remove_suffix(1);
      at_ = end + 1;
      ++line_;
    } while (now_.starts_with(comment_));
    return true;
  }
  /// To the next line if that holds data; stays where the next line is a keyword.
  bool next_data() {
    const std::size_t at = at_, line = line_;
    const std::string_view now = now_;
    while (next())
      if (!trimmed(now_).empty()) {
        if (!now_.starts_with('*')) return true;
        break;
      }
    at_ = at;
    line_ = line;
    now_ = now;
    return false;
  }
  std::string_view now() const { return now_; }
  std::size_t line() const { return line_; }

  /// The parts of this line between commas, without blanks around them.
  std::vector<std::string_view> fields() const {
    std::vector<std::string_view> out;
    std::string_view left = now_;
    for (std::size_t comma = left.find(','); comma != std::string_view::npos;
         comma = left.find(',')) {
      out.push_back(trimmed(left.substr(0, comma)));
      left.remove_prefix(comma + 1);
    }
    if (!trimmed(left).empty()) out.push_back(trimmed(left));
    return out;
  }
  /// The words of this line between blanks.
  std::vector<std::string_view> words() const {
    std::vector<std::string_view> out;
    for (std::size_t at = now_.find_first_not_of(" \t"); at != std::string_view::npos;) {
      const std::size_t end = std::min(now_.find_first_of(" \t", at), now_.size());
      out.push_back(now_.substr(at, end - at));
      at = now_.find_first_not_of(" \t", end);
    }
    return out;
  }

  double number(std::string_view text) const { return value<double>(text, "a number"); }
  std::int64_t integer(std::string_view text) const {
    return value<std::int64_t>(text, "a whole number");
  }

 private:
  template <class T>
  T value(std::string_view text, const char* what) const {
    if (text.starts_with('+')) text.remove_prefix(1);
    T out{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size() ||
        !std::isfinite(static_cast<double>(out)))
      fail(std::string{"expected "} + what + ", found " + MeshText::shown(text));
    return out;
  }

  const std::string& file_;
  std::string_view text_, comment_, now_;
  std::size_t at_ = 0, line_ = 0;
};

}  // namespace krater
