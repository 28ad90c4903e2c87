// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/study.hpp"

#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "krater/core/errors.hpp"
#include "krater/core/program.hpp"

namespace krater {

namespace {

namespace fs = std::filesystem;

/// Installed, or beside the program in the build tree: a link to that of the sources.
fs::path package(const fs::path& program) {
  std::error_code error;
  const fs::path installed = program.parent_path() / KRATER_INSTALLED_STUDY;
  const fs::path built = program.parent_path() / "krater_study";
  for (const fs::path& folder : {installed, built})
    if (fs::is_regular_file(folder / "__main__.py", error)) return folder.lexically_normal();
  throw InputError(
      fmt::format("krater study: its Python package is missing: neither {} nor {} is there; "
                  "install krater with "
                  "`cmake --install`, or keep the program in its build folder",
                  installed.lexically_normal().string(), built.string()));
}

}  // namespace

int become_study(const std::vector<std::string>& words) {
  const fs::path program = program_path();
  if (program.empty())
    throw InputError("krater study: the system does not tell where the program lies");
  const std::string folder = package(program).string();
  setenv("KRATER", program.c_str(), 1);
  std::vector<std::string> all{KRATER_PYTHON, "-B", folder};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(argv.front(), argv.data());
  throw InputError(
      fmt::format("krater study: {} cannot be started; it needs Debian's python3 with "
                  "numpy, scipy, matplotlib, h5py and yaml (tools/setup)",
                  all.front()));
}

}  // namespace krater
