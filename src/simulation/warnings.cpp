// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "krater/kinematics/energy_error.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

namespace {

constexpr double kEnergyError = 0.01;  // of the energy in the scene
constexpr double kHourglass = 0.1;     // of the internal energy: the common rule
constexpr double kHeld = 0.01;         // of the elements, more than half of whose energy it is
constexpr double kNoticed = 0.01;      // of the energy in the scene: below it no share means much

void watch_energy(const Simulation& sim, Warnings& warnings) {
  const Audit& a = sim.audit();
  const bool wrong = !(a.error_fraction() <= kEnergyError);
  warnings.judge("energy_error", wrong, sim.time(),
                 wrong ? describe_energy_error(a, kEnergyError) : "");
}

}  // namespace

Warning* Warnings::find(const std::string& kind) {
  const auto at = std::find_if(list_.begin(), list_.end(),
                               [&kind](const Warning& w) { return w.kind == kind; });
  return at == list_.end() ? nullptr : &*at;
}

void Warnings::add(const std::string& kind, double time, const std::string& text) {
  if (Warning* known = find(kind))
    known->count += 1;
  else
    list_.push_back({kind, text, 1, time});
}

void Warnings::count(const std::string& kind, double count, double time, const std::string& text) {
  if (!(count > 0)) return;
  Warning* known = find(kind);
  if (known == nullptr) known = &list_.emplace_back(Warning{kind, text, 0, time});
  known->count = count;
  known->text = text;
}

void Warnings::judge(const std::string& kind, bool wrong, double time, const std::string& text) {
  if (!wrong) {
    std::erase_if(list_, [&kind](const Warning& w) { return w.kind == kind; });
    return;
  }
  count(kind, 1, time, text);
  find(kind)->said = true;
}

std::vector<std::string> Warnings::unsaid() {
  std::vector<std::string> out;
  for (Warning& w : list_) {
    if (w.said) continue;
    w.said = true;
    out.push_back(sentence(w));
  }
  return out;
}

Json Warnings::json() const {
  Json list = Json::array();
  for (const Warning& w : list_) {
    Json j;
    j["kind"] = Json::of(w.kind);
    j["text"] = Json::of(w.text);
    j["count"] = Json::of(static_cast<std::int64_t>(w.count));
    j["first_time"] = Json::of(w.first_time);
    list.items.push_back(std::move(j));
  }
  return list;
}

void Warnings::save(Checkpoint& checkpoint) const {
  std::vector<double> numbers;
  std::string words;
  for (const Warning& w : list_) {
    numbers.insert(numbers.end(), {w.count, w.first_time, w.said ? 1.0 : 0.0});
    words += w.kind + "\n" + w.text + "\n";
  }
  if (list_.empty()) return;
  checkpoint.blobs.push_back({"warnings/numbers", {list_.size(), 3}, std::move(numbers), {}, {}});
  checkpoint.blobs.push_back({"warnings/words", {}, {}, {}, std::move(words)});
}

void Warnings::restore(const Checkpoint& checkpoint) {
  list_.clear();
  const CheckpointBlob* numbers = checkpoint.find("warnings/numbers");
  const CheckpointBlob* words = checkpoint.find("warnings/words");
  if (numbers == nullptr || words == nullptr) return;
  std::istringstream lines{words->text};
  Warning w;
  for (std::size_t i = 0; i + 2 < numbers->doubles.size(); i += 3) {
    std::getline(lines, w.kind);
    std::getline(lines, w.text);
    w.count = numbers->doubles[i];
    w.first_time = numbers->doubles[i + 1];
    w.said = numbers->doubles[i + 2] != 0;
    list_.push_back(w);
  }
}

std::string sentence(const Warning& w) {
  return w.text + fmt::format(" (from {:.3g} s)", w.first_time);
}

void watch(const Simulation& sim, Warnings& warnings) {
  const Audit& a = sim.audit();
  const double now = sim.time();
  const double left = a.removed_points - a.removed_failed;
  if (left > 0)
    warnings.count(
        "points_left", left, now,
        fmt::format("{:.0f} of {:.0f} points left the domain (grid.box) and were removed", left,
                    a.removed_points + static_cast<double>(sim.point_count())));
  if (a.penetrations > 0)
    warnings.count("points_put_back", a.penetrations, now,
                   fmt::format("points went through a closed side of the domain, by up to {:.2g} "
                               "cells, and were put back {:.0f} times",
                               a.deepest_reflection, a.penetrations));
  if (a.sound_speed_floors > 0)
    warnings.count("sound_speed_floors", a.sound_speed_floors, now,
                   fmt::format("an equation of state gave no sound speed {:.0f} times (the density "
                               "is beyond its range); a floor was taken",
                               a.sound_speed_floors));
  if (a.hugoniot_poles > 0)
    warnings.count("hugoniot_poles", a.hugoniot_poles, now,
                   fmt::format("a compression reached the pole of the linear Hugoniot {:.0f} times",
                               a.hugoniot_poles));
  watch_energy(sim, warnings);
}

void watch_points(const Simulation& sim, Warnings& warnings) {
  const TornPoints& points = sim.torn_points();
  const bool splits = sim.scene().method.numerical_fracture == NumericalFracture::split;
  std::string where;
  for (std::size_t b = 0; b < points.torn_by_body.size(); ++b)
    if (points.torn_by_body[b] > 0)
      where += fmt::format("{}{} of {}", where.empty() ? "" : ", ", points.torn_by_body[b],
                           sim.bodies()[b]->name());
  warnings.count(
      "numerical_fracture", static_cast<double>(points.torn), sim.time(),
      fmt::format("sound points have lost each other on the grid ({}; stretched to {:.2g} "
                  "times its reach): what parts there is numerical, no law; {}smaller "
                  "cells, more points, elements or a law that fails before would tell",
                  where, points.greatest_stretch,
                  splits ? "" : "method.numerical_fracture: split, "));
}

void watch_elements(const Simulation& sim, Warnings& warnings) {
  const MeshHealth& mesh = sim.elements();
  const double most = sim.audit().most_folded, elements = static_cast<double>(mesh.elements);
  if (mesh.folded > 0)
    warnings.count("folded_elements", most, sim.time(),
                   fmt::format("up to {:.0f} of {:.0f} elements were folded, a corner inside out: "
                               "they run on, but their shape is none that matter can have",
                               most, elements));
  if (!(mesh.internal > kNoticed * sim.audit().peak_energy)) return;
  if (mesh.hourglass_share() > kHourglass)
    warnings.add("hourglass_energy", sim.time(),
                 fmt::format("the hourglass holds {:.3g} % of the internal energy, and a tenth is "
                             "much: smaller elements tell whether the answer stands",
                             100 * mesh.hourglass_share()));
  const double held = static_cast<double>(mesh.held);
  if (held > kHeld * elements)
    warnings.add("hourglass_elements", sim.time(),
                 fmt::format("in {:.0f} of {:.0f} elements the hourglass is more than half of the "
                             "internal energy: there the mesh is too coarse for what happens",
                             held, elements));
}

}  // namespace krater
