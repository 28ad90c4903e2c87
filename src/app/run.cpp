// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/run.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "app/continuation.hpp"
#include "app/follow.hpp"
#include "app/signals.hpp"
#include "krater/app/closing.hpp"
#include "krater/app/effects.hpp"
#include "krater/app/folder_lock.hpp"
#include "krater/app/forecast.hpp"
#include "krater/app/known_error.hpp"
#include "krater/app/machine.hpp"
#include "krater/app/progress.hpp"
#include "krater/app/readable.hpp"
#include "krater/app/schedule.hpp"
#include "krater/app/thread_fit.hpp"
#include "krater/app/version.hpp"
#include "krater/core/errors.hpp"
#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"
#include "krater/core/stopwatch.hpp"
#include "krater/measure/gauges.hpp"
#include "krater/measure/measurements.hpp"
#include "krater/measure/outcomes.hpp"
#include "krater/measure/snapshot.hpp"

namespace krater {

namespace {

class Runner {
 public:
  /// `watch` runs since the program began to read the scene.
  Runner(const RunOptions& options, Simulation& sim, const Stopwatch<outside_names.size()>& watch)
      : options_{options},
        scene_{sim.scene()},
        sim_{sim},
        measurements_{with_points(sim)},
        outcomes_{sim_, history_titles()},
        gauges_{sim_, measurements_},
        costs_{scene_, sim_.isa_level()},
        results_{options.output.empty() ? default_output(options.scene) : options.output,
                 !options.restart.empty()},
        watch_{watch} {}
  Runner(const Runner&) = delete;

  int go();

 private:
  /// What looks at the points at the start needs all of them here.
  static const Simulation& with_points(Simulation& sim) {
    if (looks_at_points(sim.scene()) || looks_on_its_own(sim.scene())) sim.assemble();
    return sim;
  }
  void begin();
  void resume();
  std::vector<Quantity> history_columns();
  std::vector<Quantity> history_titles() const {  ///< without measuring, which measures remember
    std::vector<Quantity> row = history_row(sim_, {});
    for (Quantity& q : measurements_.titles(scene_)) row.push_back(std::move(q));
    return row;
  }
  void write_history() { results_.write_history(history_columns()); }
  void write_due(Schedule& frames, Schedule& history);
  void write_frame(double time);
  void write_checkpoint();
  /// Does a thing outside the steps, and notes how long it took.
  template <class Work>
  void timed(Outside what, Work work) {
    watch_.start();
    work();
    watch_.lap(static_cast<std::size_t>(what));
  }
  /// To the log, and aloud unless --quiet.
  void tell(const std::string& line);
  void tell_always(const std::string& line);
  void tell_progress(Progress& progress);
  void start_log();
  void watch_time_step();
  int fail(const std::string& message, Progress& progress);
  Json summary(const std::string& status, double seconds);
  double point_steps() const {
    return static_cast<double>(sim_.steps() - first_step_) *
           static_cast<double>(sim_.point_count());
  }
  int finish(const std::string& status, const std::string& message, int code,
             const Progress& progress);

  RunOptions options_;
  const Scene& scene_;
  Simulation& sim_;
  Measurements measurements_;
  Outcomes outcomes_;
  Gauges gauges_;
  EffectCosts costs_;
  ResultsFolder results_;
  FolderLock lock_;
  Stopwatch<outside_names.size()> watch_;
  int frame_ = 0;
  std::int64_t first_step_ = 0;
  std::string changed_;     ///< keys of the scene, since the checkpoint
  double foreseen_dt_ = 0;  ///< the first long step [s]; 0 once it was told that it does not hold
};

void Runner::begin() {
  const Version v = version();
  results_.set_attributes({{"program", "krater " + v.program},
                           {"revision", v.revision},
                           {"title", scene_.title},
                           {"frame", std::string{name(scene_.frame)}},
                           {"cell", fmt::format("{:.17g} m", scene_.grid.cell)}});
  if (!options_.restart.empty()) resume();
  measurements_.check(sim_);  // what cannot be measured is said before anything is written
  lock_.take(results_.path());
  try {
    if (!options_.restart.empty()) results_.continue_from(sim_.time(), history_titles());
    results_.write_text("resolved.yaml", scene_.resolved);
    start_log();
    if (options_.restart.empty()) {
      write_frame(sim_.time());
      results_.wait();  // whenever it is killed, a run has its first frame
      write_history();
    }
    write_checkpoint();
  } catch (const OutputError& e) {
    throw InputError(fmt::format("{}; choose another folder with -o", e.what()));
  }
}

void Runner::resume() {
  const Checkpoint checkpoint = read_checkpoint(options_.restart);
  const std::vector<SceneDifference> differences =
      require_same_scene(checkpoint, options_.restart, scene_);
  restore(sim_, checkpoint, options_.restart);
  measurements_.restore(checkpoint, sim_.scene(), changed_measures(differences));
  outcomes_.restore(checkpoint);
  gauges_.restore(checkpoint);
  for (const SceneDifference& d : differences) changed_ += (changed_.empty() ? "" : ", ") + d.path;
  const CheckpointBlob* counters = checkpoint.find("output");
  if (counters != nullptr) frame_ = static_cast<int>(counters->integers.at(0));
  first_step_ = sim_.steps();
}

std::vector<Quantity> Runner::history_columns() {
  if (looks_at_points(scene_)) sim_.assemble();
  sim_.look_at_elements();
  sim_.look_for_torn_points();
  const std::vector<PointSurvey> survey = sim_.survey();
  std::vector<Quantity> row = history_row(sim_, survey);
  for (Quantity& q : measurements_.row(sim_, survey)) row.push_back(std::move(q));
  return row;
}

void Runner::write_frame(double time) {
  if (draws_all_points(scene_)) sim_.assemble();
  if (sim_.steps() > 0) sim_.look_for_overlap();
  OutputFrame frame = make_frame(sim_, frame_);
  frame.time = time;
  results_.write_frame(frame);
  ++frame_;
}

void Runner::write_checkpoint() {
  Checkpoint c = sim_.save();
  c.blobs.push_back({"output", {1}, {}, {frame_}, {}});
  measurements_.save(c, scene_);
  outcomes_.save(c);
  gauges_.save(c);
  c.blobs.push_back({"scene", {}, {}, {}, scene_.resolved});
  results_.write_checkpoint(c);
}

/// Once, where the time step falls far below what the start let expect: the run will take as many
/// times longer, and something small and fast is the reason.
void Runner::watch_time_step() {
  constexpr double kTold = 20;
  if (foreseen_dt_ <= kTold * sim_.dt_free()) return;
  sim_.assemble();
  const double steps = (scene_.time.end - sim_.time()) / sim_.dt_free();
  sim_.warnings().add(
      "short_time_step", sim_.time(),
      fmt::format("the time step fell to {:.3g} s, 1/{:.0f} of what the start let expect; the rest "
                  "takes {:.3g} steps if it stays; {}",
                  sim_.dt_free(), foreseen_dt_ / sim_.dt_free(), steps, sim_.describe_limit()));
  foreseen_dt_ = 0;
}

/// What is due after a step; all of it where the answer is there, for the run ends.
void Runner::write_due(Schedule& frames, Schedule& history) {
  const bool row = history.due(sim_.time()) || scene_.output.history <= 0;
  bool ends = false;
  timed(Outside::history_and_measures, [&] {
    std::vector<Quantity> columns;
    if (row) {
      columns = history_columns();
      results_.write_history(columns);
      history.advance(sim_.time());
    }
    if (gauges_.due(sim_.time()) || outcomes_.due(sim_.time())) sim_.assemble();
    gauges_.look(sim_);
    ends = outcomes_.look(sim_, columns);
    if (ends && !row) write_history();
  });
  if (ends || frames.due(sim_.time())) timed(Outside::frames, [&] { write_frame(sim_.time()); });
  frames.advance(sim_.time());
}

int Runner::go() {
  ThreadFit fit{options_.threads};
  fit.look(sim_);
  begin();
  watch_.lap(static_cast<std::size_t>(Outside::setup));
  listen_to_signals();
  Progress progress{sim_, options_.quiet};
  Schedule frames{scene_.output.frames, scene_.time.end, sim_.time()};
  Schedule history{scene_.output.history, scene_.time.end, sim_.time()};
  double last_checkpoint = 0;
  foreseen_dt_ = sim_.expected_dt();
  try {
    while (!sim_.done() && !outcomes_.answered()) {
      if (interrupted != 0) {
        // No row of history: a continued run has none here.
        write_checkpoint();
        progress.finish();
        const std::string message = "interrupted: checkpoint written; continue with: " +
                                    continuation(options_, results_.path());
        tell_always(message);
        return finish("interrupted", message, kInterrupted, progress);
      }
      fit.look(sim_);
      sim_.expect_survey(scene_.output.history > 0 ? history.next() : 0);
      sim_.step(frames.next());
      costs_.look(sim_);
      write_due(frames, history);
      if (scene_.output.checkpoint_wall > 0 &&
          progress.seconds() - last_checkpoint > scene_.output.checkpoint_wall) {
        timed(Outside::checkpoints, [&] { write_checkpoint(); });
        last_checkpoint = progress.seconds();
      }
      tell_progress(progress);
      watch_time_step();
    }
    if (!sim_.done()) {  // the answer was there before the end
      sim_.assemble();
      sim_.judge_energy(true);
    }
  } catch (const NumericalError& e) {
    return fail(e.what(), progress);
  }
  timed(Outside::checkpoints, [&] { write_checkpoint(); });
  progress.finish();
  return finish("done", "", kDone, progress);
}

void Runner::tell(const std::string& line) {
  if (!options_.quiet) say("krater: " + line);
  results_.write_log(line);
}

void Runner::tell_always(const std::string& line) {
  say("krater: " + line);
  results_.write_log(line);
}

void Runner::tell_progress(Progress& progress) {
  const std::string line = progress.show();
  if (!line.empty()) {
    if (!progress.on_terminal() && !options_.quiet) say("krater: " + line);
    results_.write_log(line);
  }
  if (options_.quiet) return;  // warnings come at the end
  for (const std::string& text : sim_.warnings().unsaid()) {
    progress.finish();
    tell("warning: " + text);
  }
}

void Runner::start_log() {
  const Version v = version();
  std::string text = command(options_, results_.path());
  const std::string& checkpoint = options_.restart;
  if (!checkpoint.empty()) text += " --restart " + quoted(checkpoint);
  results_.write_log(
      fmt::format("krater {} ({}), {} threads: {}", v.program, v.revision, threads(), text));
  for (const std::string& note : scene_.notes) tell("note: " + note);
  if (!changed_.empty()) tell("note: changed since the checkpoint: " + changed_);
}

/// The state as it was when the step broke, for a look: a frame and a row just after the last good
/// time, so that both stay in order and a restart drops them. checkpoint.h5 holds whole states
/// only: one to continue from with a shorter step must not be lost to a broken one.
int Runner::fail(const std::string& message, Progress& progress) {
  progress.finish();
  tell_always(message);
  if (!sim_.broken()) write_checkpoint();
  const double after = sim_.time() > 0
                           ? std::nextafter(sim_.time(), std::numeric_limits<double>::infinity())
                           : 1e-15 * scene_.time.end;
  write_frame(after);
  std::vector<Quantity> row = history_columns();
  row.front().value = after;
  results_.write_history(row);
  return finish("failed", message, kNumericalFailure, progress);
}

Json Runner::summary(const std::string& status, double seconds) {
  Json j;
  j["title"] = Json::of(scene_.title);
  j["status"] = Json::of(status);
  j["frame"] = Json::of(std::string{name(scene_.frame)});
  j["cell"] = Json::of(scene_.grid.cell);
  j["time"] = Json::of(sim_.time());
  j["points"] = Json::of(static_cast<std::int64_t>(sim_.point_count()));
  j["steps"] = Json::of(sim_.steps());
  with_points(sim_);
  sim_.look_at_elements();
  sim_.look_for_torn_points();
  measurements_.summarize(sim_, j);
  outcomes_.summarize(sim_, j);
  gauges_.summarize(j);
  std::string names;
  for (const std::string& name : measurements_.without_points())
    names += (names.empty() ? "" : ", ") + name;
  sim_.warnings().judge("measures_without_points", !names.empty(), sim_.time(),
                        "no point is left for the measures " + names);
  j["warnings"] = sim_.warnings().json();
  j["audit"] = audit_json(sim_);
  Json& limiters = j["dt_limiters"];
  limiters["0"] = Json::of("wave speed");
  limiters["1"] = Json::of("material velocity");
  limiters["2"] = Json::of("volume change");
  // Machine and clock: everything above is the same for any number of threads, everything below is
  // not.
  Json& machine = j["machine"] = machine_json(sim_, seconds, point_steps());
  for (std::size_t i = 0; i < outside_names.size(); ++i)
    machine["seconds_outside_steps"][outside_names[i]] = Json::of(watch_.seconds(i));
  add_command(machine, options_, results_.path());
  j["program"] = program_json();
  return j;
}

int Runner::finish(const std::string& status, const std::string& message, int code,
                   const Progress& progress) {
  Json s = summary(status, progress.seconds());
  if (!message.empty()) s["message"] = Json::of(message);
  const std::vector<std::string> errors =
      add_known_errors({options_.scene, results_.path(), scene_.grid.cell, progress.seconds()}, s);
  const EffectReport report = report_run(sim_, costs_, results_.path(), point_steps());
  s["effects"] = effects_json(scene_, report);
  s["machine"]["ns_per_point_step"] = effect_times_json(scene_, report);
  results_.write_summary(s);
  gauges_.write(results_);
  results_.flush();
  for (const std::string& line : outcomes_.sentences()) tell(line);
  for (const std::string& line : gauges_.sentences()) tell(line);
  if (code == kDone) {
    for (const std::string& line : effect_table(scene_, report)) tell(line);
    for (const std::string& line : report.sentences) tell("advice: " + line);
    for (const std::string& line : closing_lines(s)) tell(line);
    for (const std::string& line : errors) tell(line);
  }
  if (outcomes_.answered())
    tell(fmt::format("stopped at {} of {}: {}", readable(sim_.time(), "s"),
                     readable(scene_.time.end, "s"), outcomes_.answer()));
  for (const std::string& line : removal_notes(sim_)) tell("note: " + line);
  const std::vector<Warning>& warnings = sim_.warnings().all();
  for (const Warning& warning : warnings) tell_always("warning: " + sentence(warning));
  const std::string with = warnings.empty() ? ""
                                            : fmt::format(" with {} warning{}", warnings.size(),
                                                          warnings.size() > 1 ? "s" : "");
  tell(fmt::format("{}{} after {} steps, results in {}", status, with, sim_.steps(),
                   results_.path()));
  const int exit_code = code == kDone && options_.strict && !warnings.empty() ? int{kWarned} : code;
  return options_.json ? print_summary(std::move(s), results_.path(), exit_code) : exit_code;
}

}  // namespace

int run(const RunOptions& options) {
  set_threads(options.threads);
  flush_denormals();
  Stopwatch<outside_names.size()> watch;
  Readiness ready;
  if (!ranks::first()) ignore_signals();  // the first rank hears them
  const Scene scene = read_scene(options.scene, options.overrides);
  require_feasible(scene, forecast(scene));
  Simulation sim{scene};
  ready.agree(scene.resolved);
  sim.distribute();
  if (ranks::first()) return Runner{options, sim, watch}.go();
  sim.follow([&options] { return read_checkpoint(options.restart); });
  return kDone;
}

}  // namespace krater
