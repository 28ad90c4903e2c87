// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/closing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <fmt/format.h>

#include "krater/app/progress.hpp"
#include "krater/app/readable.hpp"
#include "krater/app/run.hpp"

namespace krater {

namespace {

/// Member of an object, or null; nothing is made, unlike Json::operator[].
const Json* find(const Json* json, const std::string& key) {
  if (json == nullptr) return nullptr;
  for (std::size_t i = 0; i < json->keys.size(); ++i)
    if (json->keys[i] == key) return &json->items[i];
  return nullptr;
}

double number(const Json* json) {
  if (json != nullptr && json->kind == Json::Kind::number) return json->number;
  if (json != nullptr && json->kind == Json::Kind::integer)
    return static_cast<double>(json->integer);
  return std::nan("");
}

double number(const Json* json, const std::string& key) { return number(find(json, key)); }

std::string text(double value, double size, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value / size, digits) : "-";
}

using Row = std::array<std::string, 6>;

Row measure_row(const std::string& name, const Json& measure) {
  const double value = number(&measure, "value"), band = number(&measure, "uncertainty");
  const Json* reference = find(&measure, "reference");
  const double wanted = number(reference, "value"), bar = number(reference, "error");
  const double off = number(&measure, "difference_percent");
  const Json* unit = find(&measure, "unit");
  const double largest = std::max(std::isfinite(value) ? std::abs(value) : 0,
                                  std::isfinite(wanted) ? std::abs(wanted) : 0);
  const ShownUnit shown = shown_unit(largest, unit == nullptr ? "" : unit->text);
  return {"  " + name,
          text(value, shown.size, 5),
          std::isfinite(band) ? text(band, shown.size, 2) : "?",
          shown.name,
          text(wanted, shown.size, 5) +
              (std::isfinite(bar) ? " +- " + text(bar, shown.size, 2) : std::string{}),
          std::isfinite(off) ? fmt::format("{:+.2f} %", off) : "-"};
}

void add_measures(const Json& summary, std::vector<std::string>& lines) {
  const Json* measures = find(&summary, "measures");
  if (measures == nullptr || measures->items.empty()) return;
  std::vector<Row> rows{{"measures", "value", "+-", "unit", "reference", "difference"}};
  for (std::size_t i = 0; i < measures->items.size(); ++i)
    rows.push_back(measure_row(measures->keys[i], measures->items[i]));
  std::array<std::size_t, 6> width{};
  for (const Row& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) width[k] = std::max(width[k], row[k].size());
  const bool bands =
      std::any_of(rows.begin() + 1, rows.end(), [](const Row& r) { return r[2] != "?"; });
  for (const Row& row : rows) {
    std::string line = fmt::format("{:<{}}", row[0], width[0]);
    for (std::size_t k = 1; k < row.size(); ++k)
      if (k != 2 || bands)
        line += k == 3 ? fmt::format("  {:<{}}", row[k], width[k])
                       : fmt::format("  {:>{}}", row[k], width[k]);
    lines.push_back(line);
  }
}

struct Entry {
  const char *key, *words;
};
constexpr Entry kMoved[] = {{"external_work", "work from outside"},
                            {"wall_work", "work of driven sides"}};
constexpr Entry kHeld[] = {{"kinetic_energy", "kinetic"},
                           {"internal_energy", "internal"},
                           {"removed_energy", "left with removed points"}};
constexpr Entry kParts[] = {
    {"plastic_work", "plastic work"}, {"viscous_work", "artificial viscosity"},
    {"friction_work", "friction"},    {"contact_heat", "heat of contact"},
    {"wall_heat", "heat of sides"},   {"hourglass_energy", "hourglass control"}};
constexpr double kSmall = 5e-4;  ///< of the energy: less is not worth a word

void add_energy(const Json& summary, std::vector<std::string>& lines) {
  const Json* audit = find(&summary, "audit");
  const double start = number(audit, "initial_energy");
  if (!std::isfinite(start)) return;
  std::string in = readable(start, "J", 5) + " at the start", held, parts;
  for (const Entry& e : kMoved)
    if (const double x = number(audit, e.key); std::isfinite(x) && x != 0)
      in += fmt::format(" {} {} {}", x < 0 ? "-" : "+", readable(std::abs(x), "J", 5), e.words);
  double most = std::abs(start);
  for (const Entry& e : kHeld) {
    const double x = number(audit, e.key);
    if (!std::isfinite(x) || (x == 0 && !held.empty())) continue;
    most = std::max(most, std::abs(x));
    held += fmt::format("{}{} {}", held.empty() ? "" : " + ", readable(x, "J", 5), e.words);
  }
  lines.push_back("energy: " + in + " = " + held);
  for (const Entry& e : kParts) {
    const double x = number(audit, e.key);
    if (std::isfinite(x) && std::abs(x) > kSmall * most)
      parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", e.words, readable(x, "J"));
  }
  const double error = number(audit, "energy_error_fraction");
  lines.push_back(
      fmt::format("  {}{}unphysical {:.2g} %", parts, parts.empty() ? "" : "; ", 100 * error));
}

const std::map<std::string, const char*> kPhases{{"scatter", "points to grid"},
                                                 {"nodes", "grid"},
                                                 {"contact", "contact"},
                                                 {"boundary", "sides"},
                                                 {"gather_and_stress", "grid to points and laws"},
                                                 {"migrate", "moving points"},
                                                 {"history_and_measures", "history and measures"},
                                                 {"frames", "frames"},
                                                 {"checkpoints", "checkpoints"}};
constexpr double kShare = 0.005;  ///< of the time

void add_time(const Json& summary, std::vector<std::string>& lines) {
  const Json* machine = find(&summary, "machine");
  const double wall = number(machine, "wall_seconds");
  if (!std::isfinite(wall)) return;
  const Json* outside = find(machine, "seconds_outside_steps");
  const double setup = number(outside, "setup");
  std::vector<std::pair<double, std::string>> parts;
  double told = 0;
  for (const Json* group : {find(machine, "seconds"), outside})
    for (std::size_t i = 0; group != nullptr && i < group->keys.size(); ++i)
      if (const auto phase = kPhases.find(group->keys[i]); phase != kPhases.end()) {
        const double seconds = number(&group->items[i]);
        told += seconds;
        parts.emplace_back(seconds, phase->second);
      }
  parts.emplace_back(wall - told, "the rest");
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string list;
  for (const auto& [seconds, words] : parts)
    if (wall > 0 && seconds > kShare * wall)
      list += fmt::format("{}{} {:.0f} %", list.empty() ? "" : ", ", words, 100 * seconds / wall);
  lines.push_back(
      fmt::format("time: {}, after {} to set up", readable(wall, "s", 3), readable(setup, "s", 3)));
  lines.push_back(fmt::format("  {}; {:.3g} million point-steps/s, {:.0f} MiB of memory", list,
                              1e-6 * number(machine, "point_steps_per_second"),
                              number(machine, "peak_resident_bytes") / (1024.0 * 1024.0)));
}

}  // namespace

std::vector<std::string> closing_lines(const Json& summary) {
  std::vector<std::string> lines;
  add_measures(summary, lines);
  add_energy(summary, lines);
  add_time(summary, lines);
  return lines;
}

std::vector<std::string> removal_notes(const Simulation& sim) {
  std::vector<std::string> lines;
  const Eroded eroded = sim.mesh() != nullptr ? sim.mesh()->eroded() : Eroded{};
  const double failed = sim.audit().removed_failed - eroded.all();
  if (failed > 0)
    lines.push_back(
        fmt::format("{:.0f} points failed and were removed, as the scene asks", failed));
  if (eroded.all() > 0) lines.push_back(describe_eroded(eroded));
  const Eroded converted = sim.mesh() != nullptr ? sim.mesh()->converted() : Eroded{};
  if (converted.all() > 0) lines.push_back(describe_converted(converted));
  return lines;
}

int print_summary(Json summary, const std::string& folder, int code) {
  summary["results"] = Json::of(folder);
  summary["exit_code"] = Json::of(code);
  std::fputs(to_text(summary).c_str(), stdout);
  if (std::fflush(stdout) == 0) return code;
  say("krater: standard output cannot be written");
  return kBadInput;
}

}  // namespace krater
