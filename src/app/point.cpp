// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/point.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "krater/app/card_doctor.hpp"
#include "krater/app/folder_lock.hpp"
#include "krater/app/progress.hpp"
#include "krater/app/version.hpp"
#include "krater/core/errors.hpp"
#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/kernel_levels.hpp"
#include "krater/point_driver/loading_path.hpp"
#include "krater/scene/point.hpp"
#include "point_driver/point_table.hpp"

namespace krater {

namespace {

/// Columns of the printed summary, where the table has them.
constexpr const char* kShown[] = {
    "particle_speed", "shock_speed",     "time",        "strain_xx", "F_xy",
    "stress_xx",      "stress_yy",       "stress_xy",   "pressure",  "von_mises",
    "triaxiality",    "plastic_strain",  "temperature", "damage",    "density",
    "compression",    "internal_energy", "sound_speed", "work",      "energy_balance"};

/// Puts a point into a state behind a shock. The step at rest gives what follows from it: the
/// temperature, where that is a function of the energy.
void set_state(MaterialPoint& point, const ShockState& s) {
  point.set(field::Density::info, 0, s.density);
  point.set(field::Pressure::info, 0, s.pressure);
  point.set(field::InternalEnergy::info, 0, s.energy);
  point.set(field::SoundSpeed::info, 0, s.sound_speed);
  point.step(Eigen::Matrix3d::Zero(), 1.0);
}

class PointRunner {
 public:
  PointRunner(const RunOptions& options, PointScene point);
  int go();

 private:
  std::vector<ShockState> shocked() const;
  void run_hugoniot();
  void run_path();
  void note_failure(const PointRecord& record, const MaterialPoint& point, int step);
  void count_events(const Ledger& ledger, int jumps);
  void write(const std::string& status, const std::string& message);
  Json summary(const std::string& status, const std::string& message) const;
  void print() const;

  RunOptions options_;
  PointScene scene_;
  ResultsFolder results_;
  FolderLock lock_;
  IsaLevel level_ = best_isa_level();
  std::vector<std::string> stages_;
  std::vector<TableColumn> table_;
  std::vector<std::pair<const char*, std::int64_t>> events_;
  Json failure_ = Json::null();
  int steps_ = 0;
  long updates_ = 0;
  double seconds_ = 0;
};

PointRunner::PointRunner(const RunOptions& options, PointScene point)
    : options_{options},
      scene_{std::move(point)},
      results_{options.output.empty()
                   ? std::filesystem::path(options.scene).stem().string() + "_out"
                   : options.output} {}

std::vector<ShockState> PointRunner::shocked() const {
  const MaterialOptions& m = scene_.material;
  const std::unique_ptr<ScalarEos> eos = make_scalar_eos(
      m.eos->law, m.eos->values.data(), {m.density, m.shear_modulus, m.initial_temperature});
  std::vector<ShockState> states;
  try {
    for (const double up : scene_.path.particle_speeds) states.push_back(behind_shock(*eos, up));
    for (const double rho : scene_.path.densities) states.push_back(shocked_to_density(*eos, rho));
  } catch (const InputError& e) {
    throw InputError(scene_.path.where + ": " + e.what());
  }
  return states;
}

void PointRunner::run_hugoniot() {
  const MaterialOptions& m = scene_.material;
  const std::vector<ShockState> states = shocked();
  const std::unique_ptr<ScalarEos> eos = make_scalar_eos(
      m.eos->law, m.eos->values.data(), {m.density, m.shear_modulus, m.initial_temperature});
  std::int64_t poles = 0;
  for (const ShockState& s : states) poles += eos->beyond_pole(s.density) ? 1 : 0;
  events_ = {{"hugoniot_poles", poles}};
  stages_ = {"eos: " + m.eos->name};
  table_ = hugoniot_table(states, m.density);
  if (!m.heating || m.heating->name != "energy") return;  // else the heat of shocks is not known
  table_.push_back({"temperature", "K", "behind the shock", {}});
  for (const ShockState& s : states) {
    MaterialPoint point{m, scene_.length, stage_factory(level_)};
    set_state(point, s);
    table_.back().values.push_back(point.value(field::Temperature::info));
  }
}

/// When and how far the point was when it failed.
void PointRunner::note_failure(const PointRecord& record, const MaterialPoint& point, int step) {
  failure_ = Json{};
  failure_["step"] = Json::of(step);
  failure_["time"] = Json::of(record.time());
  failure_["equivalent_strain"] = Json::of(record.equivalent_strain());
  failure_["plastic_strain"] = Json::of(point.value(field::PlasticStrain::info));
}

void PointRunner::count_events(const Ledger& ledger, int jumps) {
  const auto whole = [](double x) { return static_cast<std::int64_t>(x); };
  events_ = {{"failures", whole(ledger.failures)},
             {"snap_backs", whole(ledger.snap_backs) + jumps},
             {"spalls", whole(ledger.spalls)},
             {"sound_speed_floors", whole(ledger.sound_speed_floors)},
             {"hugoniot_poles", whole(ledger.hugoniot_poles)}};
}

void PointRunner::run_path() {
  MaterialPoint point{scene_.material, scene_.length, stage_factory(level_)};
  for (const NamedStage& s : point.stages()) stages_.push_back(s.name);
  const bool released = scene_.path.kind == PathKind::release_isentrope;
  const double c0 = point.value(field::SoundSpeed::info);
  const double modulus = scene_.material.density * c0 * c0;
  double particle_speed = 0;
  if (released) {
    const ShockState start = shocked().front();
    particle_speed = start.particle_speed;
    set_state(point, start);
  }
  const LoadingPath path{scene_.path, scene_.steps, point.value(field::Pressure::info), modulus};
  PathDriver driver{point};
  PointRecord record{point, scene_.material.initial_temperature, released, particle_speed};
  std::string problem;
  for (int n = 0; n < path.steps() && problem.empty(); ++n) {
    const PathStep step = path.step(n);
    try {
      const Eigen::Matrix3d map = driver.take(step);
      const bool last = n + 1 == path.steps();
      record.follow(map, step.dt, driver.trials(), last || (n + 1) % scene_.every == 0);
      ++steps_;
      const bool failed = point.value(field::Failed::info) > 0.5;
      if (failed && failure_.kind == Json::Kind::null) note_failure(record, point, n + 1);
    } catch (const NumericalError& e) {
      problem = fmt::format("{}: step {} of {}, t = {:.6g} s: {}", scene_.path.where, n + 1,
                            path.steps(), record.time() + step.dt, e.what());
    }
  }
  table_ = record.columns();
  count_events(point.ledger(), driver.jumps());
  if (driver.jumps() > 0 && !options_.quiet) {
    const PathDriver::Jump& j = driver.first_jump();
    say(
        fmt::format("krater: note: {}: the law snaps back: the stress along x went from {:.6g} to "
                    "{:.6g} Pa within a strain of {:.3g}, and the path jumped there ({} times in "
                    "all); between the two no strain that only grows can lead",
                    scene_.path.where, j.from, j.to, j.strain, driver.jumps()));
  }
  updates_ = driver.updates();
  seconds_ = driver.seconds();
  if (!problem.empty()) {
    write("failed", problem);
    throw NumericalError(problem);
  }
}

Json PointRunner::summary(const std::string& status, const std::string& message) const {
  const Version v = version();
  Json j;
  j["title"] = Json::of(scene_.title);
  j["status"] = Json::of(status);
  if (!message.empty()) j["message"] = Json::of(message);
  j["material"] = Json::of(scene_.material.name);
  j["path"] = Json::of(name(scene_.path.kind));
  j["steps"] = Json::of(steps_);
  Json& final = j["final"];
  for (const TableColumn& c : table_) final[c.name] = Json::of(c.values.back());
  if (failure_.kind != Json::Kind::null) j["failure"] = failure_;
  Json& events = j["events"];
  for (const auto& [event, count] : events_) events[event] = Json::of(count);
  Json& machine = j["machine"];
  machine["instruction_set"] = Json::of(std::string{name_of(level_)});
  machine["updates"] = Json::of(static_cast<std::int64_t>(updates_));
  // A batch of one point: most of it is the call of the stages and seven idle lanes.
  machine["ns_per_update"] =
      updates_ > 0 ? Json::of(1e9 * seconds_ / static_cast<double>(updates_)) : Json::null();
  Json& program = j["program"];
  program["version"] = Json::of(v.program);
  program["revision"] = Json::of(v.revision);
  program["compiler"] = Json::of(v.compiler);
  program["build"] = Json::of(v.build);
  return j;
}

void PointRunner::write(const std::string& status, const std::string& message) {
  const Version v = version();
  results_.set_attributes({{"program", "krater " + v.program},
                           {"revision", v.revision},
                           {"title", scene_.title},
                           {"material", scene_.material.name},
                           {"path", name(scene_.path.kind)}});
  lock_.take(results_.path());
  results_.write_text("resolved.yaml", scene_.resolved);
  results_.write_table("point", table_);
  results_.write_summary(summary(status, message));
}

void PointRunner::print() const {
  fmt::print("{}\n{}: {}, {} rows\nstages:", scene_.title, scene_.material.name,
             name(scene_.path.kind), table_.front().values.size());
  for (const std::string& stage : stages_) fmt::print(" {};", stage);
  fmt::print("\n{:<18} {:>14}  {:<8} {:>14} {:>14}\n", "", "end", "unit", "least", "greatest");
  for (const char* shown : kShown) {
    for (const TableColumn& c : table_) {
      if (c.name != shown) continue;
      double least = c.values.front(), greatest = least;
      for (const double x : c.values) {
        least = std::fmin(least, x);
        greatest = std::fmax(greatest, x);
      }
      if (least == 0 && greatest == 0) continue;
      fmt::print("{:<18} {:>14.6g}  {:<8} {:>14.6g} {:>14.6g}\n", c.name, c.values.back() + 0.0,
                 c.unit, least + 0.0, greatest + 0.0);
    }
  }
  std::string happened;
  for (const auto& [event, count] : events_)
    if (count > 0) happened += fmt::format("{}{} {}", happened.empty() ? "" : ", ", event, count);
  fmt::print("events: {}\n", happened.empty() ? "none" : happened);
  if (updates_ > 0)
    fmt::print("{} steps, {} updates, {:.0f} ns each (a batch of one)\n", steps_, updates_,
               1e9 * seconds_ / static_cast<double>(updates_));
  fmt::print("results in {}\n", results_.path());
}

int PointRunner::go() {
  if (scene_.path.kind == PathKind::hugoniot)
    run_hugoniot();
  else
    run_path();
  write("done", "");
  if (!options_.quiet) print();
  return kDone;
}

}  // namespace

int run_point(const RunOptions& options) {
  flush_denormals();
  PointScene point = read_point(options.scene, options.overrides);
  if (!options.quiet)
    for (const std::string& note : point.notes) say("krater: note: " + note);
  if (!options.quiet)
    for (const std::string& doubt : doubt_constants(point.material))
      say(fmt::format("krater: doubt: {}: {}", point.material.name, doubt));
  return PointRunner{options, std::move(point)}.go();
}

}  // namespace krater
