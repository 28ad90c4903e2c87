// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/outcomes.hpp
/// The outcomes of a scene along a run, and whether its answer is there (time.stop_when). Looks are
/// taken at times k * every, as outputs are, and kept in the checkpoint: a run that is continued
/// ends in the same step.
#include <functional>
#include <string>
#include <vector>

#include "krater/measure/outcome.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

class Outcomes {
 public:
  /// Of a simulation at its start. `columns`: titles of the history, for expressions. Throws
  /// InputError.
  Outcomes(const Simulation& sim, const std::vector<Quantity>& columns);

  /// After a step; `row`: the row of history written in it, or empty. True: the answer is there.
  bool look(const Simulation& sim, const std::vector<Quantity>& row);
  bool due(double time) const;  ///< a look then reads points
  bool answered() const { return answered_; }
  const std::string& answer() const { return scene_.stop.text; }

  /// "outcomes" and "stopped" of summary.json.
  void summarize(const Simulation& sim, Json& summary);
  /// A sentence for each outcome, after summarize().
  const std::vector<std::string>& sentences() const { return sentences_; }

  void save(Checkpoint& checkpoint) const;
  void restore(const Checkpoint& checkpoint);

 private:
  struct Watched {
    OutcomeStart start;
    std::vector<OutcomeLook> looks;
    double next = 0;  ///< time of the next look [s]
  };
  void schedule(std::size_t i, double now);
  void take(const Simulation& sim, std::size_t i);
  bool judge(const Simulation& sim, const std::vector<Quantity>& row) const;
  Json describe(const Simulation& sim, std::size_t i);

  const Scene& scene_;
  std::vector<Watched> watched_;  ///< by outcome
  std::function<double(const std::vector<double>&)> condition_;
  bool answered_ = false;
  std::vector<std::string> sentences_;
};

}  // namespace krater
