// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/yaml/problems.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>

#include "krater/core/errors.hpp"

namespace krater::scene {

namespace {

constexpr std::size_t kMostProblems = 10;
constexpr std::size_t kLongestQuote = 60;

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// Number of insertions, deletions, replacements and swaps of neighbours that turn a into b.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), current(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = last[j - 1] + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                           lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) current[j] = std::min(current[j], before_last[j - 2] + 1);
    }
    std::swap(before_last, last);
    std::swap(last, current);
  }
  return last[b.size()];
}

}  // namespace

void Problems::add(const std::string& file, int line, const std::string& path,
                   const std::string& message) {
  const std::string place = describe_place(file, line, path);
  list_.push_back({file, line, place.empty() ? message : place + ": " + message});
  if (list_.size() >= kMostProblems) throw_if_any();
}

void Problems::throw_if_any() const {
  if (list_.empty()) return;
  std::vector<Problem> sorted = list_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Problem& a, const Problem& b) {
    return a.file != b.file ? a.file < b.file : a.line < b.line;
  });
  std::string text;
  for (const Problem& problem : sorted) text += (text.empty() ? "" : "\n") + problem.text;
  if (list_.size() >= kMostProblems) text += "\n(there may be more: reading stopped here)";
  throw InputError(text);
}

std::string describe_place(const std::string& file, int line, const std::string& path) {
  std::string place = file;
  if (line > 0) place += ":" + std::to_string(line);
  if (!path.empty()) place += (place.empty() ? "" : ": ") + path;
  return place;
}

std::string nearest(std::string_view name, const std::vector<std::string>& known) {
  if (name.size() > kLongestQuote) return "";
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    // A distance of the whole word means that nothing agrees: `x` is not a misspelt `z`.
    if (distance >= std::max(name.size(), candidate.size())) continue;
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  const std::string near = nearest(name, known);
  if (const std::size_t at = name.find("diameter"); near.empty() && at != std::string_view::npos) {
    const std::string radius = std::string{name.substr(0, at)} + "radius" +
                               std::string{name.substr(at + std::string_view{"diameter"}.size())};
    if (std::find(known.begin(), known.end(), radius) != known.end())
      return " (give the " + radius + ", half of it; known: " + join(known) + ")";
  }
  return " (" + (near.empty() ? std::string{} : "did you mean " + near + "? ") +
         "known: " + (known.empty() ? std::string{"none"} : join(known)) + ")";
}

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string quote(std::string_view text) {
  std::size_t length = std::min(text.size(), kLongestQuote);
  // Not in the middle of a UTF-8 sequence.
  while (length < text.size() && length > 0 &&
         (static_cast<unsigned char>(text[length]) & 0xC0u) == 0x80u)
    --length;
  std::string out = "'";
  for (char c : text.substr(0, length))
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return out + (length < text.size() ? "...'" : "'");
}

}  // namespace krater::scene
