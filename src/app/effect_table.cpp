// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "krater/app/effects.hpp"

namespace krater {

namespace {

std::string line(const std::string& effect, const std::string& where, const std::string& bytes,
                 const std::string& time, const std::string& influence, const std::string& word) {
  std::string text = fmt::format("{:<34} {:<26} {:>7} {:>6}  {:<34} {}", effect, where, bytes, time,
                                 influence, word);
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

std::string number(double x, int digits) {
  return std::isnan(x) ? "-" : fmt::format("{:.{}f}", x, digits);
}

/// Effects of one owner: what is on or advised about, then what is off.
void add_rows(const EffectReport& report, int material, std::vector<std::string>& lines) {
  std::string off;
  for (const Effect& e : report.effects) {
    if (e.material != material) continue;
    if (e.on() || !e.word.empty())
      lines.push_back(line(fmt::format("  {}: {}", e.name(), e.on() ? e.law : "off"),
                           e.on() ? e.where : "-", number(e.bytes, 0), number(e.nanoseconds, 1),
                           e.influence.empty() ? "-" : e.influence, e.word.empty() ? "-" : e.word));
    else if (e.kind != EffectKind::rate)
      off += fmt::format("{}{}", off.empty() ? "" : ", ", e.name());
  }
  if (!off.empty()) lines.push_back("  off: " + off);
}

std::string owner(const Scene& scene, const Effect& e) {
  return e.material < 0 ? "" : scene.materials[static_cast<std::size_t>(e.material)].name + ".";
}

}  // namespace

std::vector<std::string> effect_table(const Scene& scene, const EffectReport& report) {
  std::vector<std::string> lines{line("effects (ns per point and step)", "called for by", "B/point",
                                      "ns", "influence", "advice")};
  int material = -1;
  for (const Effect& e : report.effects) {
    if (e.material == material) continue;
    material = e.material;
    const auto m = static_cast<std::size_t>(material);
    lines.push_back(material < 0 ? "scene" : scene.materials[m].name);
    add_rows(report, material, lines);
    if (material >= 0 && !std::isnan(report.stages[m]))
      lines.push_back(line("  all its stages", "", "", number(report.stages[m], 1), "", ""));
  }
  if (!std::isnan(report.step))
    lines.push_back(line("  whole step", "", "", number(report.step, 1), "", ""));
  return lines;
}

Json effects_json(const Scene& scene, const EffectReport& report) {
  Json out = Json::array();
  for (const Effect& e : report.effects) {
    Json& row = out.items.emplace_back();
    row["effect"] = Json::of(std::string{e.name()});
    row["key"] = Json::of(e.key);
    if (e.material >= 0)
      row["material"] = Json::of(scene.materials[static_cast<std::size_t>(e.material)].name);
    row["law"] = Json::of(e.on() ? e.law : "off");
    if (e.on()) row["called_for_by"] = Json::of(e.where);
    if (!std::isnan(e.bytes)) row["bytes_per_point"] = Json::of(e.bytes);
    if (!e.influence.empty()) row["influence"] = Json::of(e.influence);
    if (!e.word.empty()) row["advice"] = Json::of(e.word);
  }
  return out;
}

Json effect_times_json(const Scene& scene, const EffectReport& report) {
  Json out;
  for (const Effect& e : report.effects)
    if (!std::isnan(e.nanoseconds)) out[owner(scene, e) + e.name()] = Json::of(e.nanoseconds);
  for (std::size_t m = 0; m < report.stages.size(); ++m)
    if (!std::isnan(report.stages[m]))
      out[scene.materials[m].name + ".all_stages"] = Json::of(report.stages[m]);
  if (!std::isnan(report.step)) out["whole_step"] = Json::of(report.step);
  return out;
}

}  // namespace krater
