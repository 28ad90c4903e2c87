// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/continuation.hpp"

#include <fmt/format.h>

namespace krater {

std::string quoted(const std::string& word) {
  if (!word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                              "0123456789_-+./=:,@%") == std::string::npos)
    return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string{"'\\''"} : std::string{c};
  return out + "'";
}

std::string command(const RunOptions& options, const std::string& folder) {
  std::string text = "krater run " + quoted(options.scene);
  for (const std::string& setting : options.overrides) text += " --set " + quoted(setting);
  if (options.threads > 0) text += fmt::format(" -j {}", options.threads);
  return text + " -o " + quoted(folder);
}

std::string continuation(const RunOptions& options, const std::string& folder) {
  return command(options, folder) + " --restart " + quoted(folder + "/checkpoint.h5");
}

}  // namespace krater
