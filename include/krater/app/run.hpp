// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/run.hpp
/// `krater run`: step a scene to its end, writing frames, history, checkpoints and the summary on
/// the way.
#include <string>
#include <vector>

namespace krater {

enum ExitCode : int {
  kDone = 0,
  kBadInput = 2,
  kNumericalFailure = 3,
  kInterrupted = 4,
  kWarned = 5  ///< done, with warnings, under --strict
};

struct RunOptions {
  std::string scene;
  std::string output;                  ///< folder; empty: SCENE_out in the current directory
  std::vector<std::string> overrides;  ///< --set path=value
  std::string restart;                 ///< checkpoint file; empty: from the start
  /// --accuracy 2% --measures length --budget 20min: a study (app/study.hpp)
  std::string accuracy, measures, budget;
  int threads = 0;  ///< 0: all
  bool quiet = false;
  bool json = false;    ///< one JSON object on standard output
  bool strict = false;  ///< a run that ends with warnings is not done
};

/// Returns an ExitCode; throws InputError before anything is written.
int run(const RunOptions& options);

}  // namespace krater
