// SPDX-License-Identifier: GPL-3.0-or-later
// What is asked of a run: measures, references, outcomes, gauges.
#include "krater/scene/measures.hpp"

#include <string_view>
#include <utility>

#include "scene/declarations/declarations.hpp"
#include "scene/readers/readers.hpp"

namespace krater::scene {

using namespace forms;

namespace {

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for (const MeasureKindInfo& kind : measure_kinds()) names.emplace_back(kind.name);
  return names;
}

Form face() {
  return word({"r_min", "r_max", "x_min", "x_max", "y_min", "y_max", "z_min", "z_max"});
}

}  // namespace

std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for (const FieldName& field : known_fields()) names.emplace_back(field.name);
  return names;
}

namespace {

BlockInfo of_every_kind() {
  return BlockInfo{
      "measure",
      "A number to follow. Its kind says which keys it takes.",
      {{"kind", "what is measured", {word(kinds())}, kMust},
       {"body", "a body, or a list of them", {text(), list({text()})}, kMust},
       {"axis",
        "an axis by name, or any line as a vector",
        {word({"r", "x", "y", "z"}), vector("1")},
        kWhereUsed},
       {"by",
        "who pushes: a body in contact, a side that is a wall or driven, or all",
        {text()},
        kWhereUsed},
       {"at", "the height of a diameter", {block(measure_at_block)}, kWhereUsed},
       {"field", "a scalar of the points", {word(field_names())}, kWhereUsed},
       {"target", "the body that is penetrated", {text()}, kWhereUsed},
       {"face", "an original face of the body by its outward normal", {face()}, kWhereUsed},
       {"level", "depth below the original face", {number("m", Range::positive)}, "(grid.cell)"},
       {"within", "heights that count", {block(measure_within_block)}, "(all heights)"},
       {"mass_share",
        "share of the mass that the extent holds; of an extreme, that reaches the "
        "value, 0: a single point",
        {number("1", Range::fraction)},
        "(debris_extent: 1; maximum, minimum: 0.001)"},
       {"piece",
        "of the connected pieces all, or the heaviest",
        {word({"all", "largest"})},
        "(all; of craters, holes and bulges largest)"},
       {"least_points",
        "only pieces of at least so many points, 0: all",
        {integer(0, 1'000'000'000)},
        "(0; of fragments a piece of two cells)"},
       {"region", "bounds of the positions that count", {block(bounds_block)}, ""},
       {"keep",
        "the value at the time, or the extreme of all rows so far",
        {word({"now", "largest", "smallest"})},
        "now"},
       {"history", "is it a column of the history?", {flag()}, "(by kind)"}}};
}

/// A word in the table of kinds, the key it stands for, and what it is there when left out.
struct Told {
  std::string_view word;
  const char *key, *fallback;
};

constexpr Told kTold[] = {{"axis", "axis", kMust},
                          {"direction", "axis", kMust},
                          {"turn", "axis", "(required in 3d)"},
                          {"by", "by", kMust},
                          {"at", "at", kMust},
                          {"field", "field", kMust},
                          {"target", "target", kMust},
                          {"face", "face", kMust},
                          {"z_face", "face", kMust},
                          {"level", "level", "(grid.cell)"},
                          {"within", "within", "(all heights)"},
                          {"mass_share", "mass_share", ""}};

/// The block of one kind: the keys of every measure and those that the table of kinds names.
BlockInfo of_kind(const MeasureKindInfo& kind, const BlockInfo& every) {
  const std::string unit = *kind.unit == '\0' ? "that of the field" : kind.unit;
  BlockInfo out{
      "measure." + std::string{kind.name}, std::string{kind.meaning} + " [" + unit + "]", {}};
  const auto take = [&](const char* key, std::string fallback) {
    out.keys.push_back(declared(every, key));
    out.keys.back().fallback = std::move(fallback);
  };
  take("kind", kMust);
  out.keys.back().forms = {word({kind.name})};
  take("body", kMust);
  const std::string keys = " " + std::string{kind.keys} + " ";
  for (const Told& told : kTold) {
    if (keys.find(" " + std::string{told.word} + " ") == std::string::npos) continue;
    const bool extent = kind.kind == MeasureKind::debris_extent;
    take(told.key, *told.fallback != '\0' ? told.fallback : extent ? "1" : "0.001");
    if (told.word == "axis") out.keys.back().forms.resize(1);  // no other line
  }
  if (kind.selects) {
    take("piece", kind.whole ? "largest" : "all");
    take("least_points", kind.kind == MeasureKind::fragments ? "(a piece of two cells)" : "0");
    take("region", "");
  }
  take("keep", "now");
  take("history", kind.in_history ? "true" : "(true with keep, else false)");
  return out;
}

}  // namespace

const BlockInfo& measure_block() {
  static const BlockInfo info = [] {
    BlockInfo every = of_every_kind();
    for (const MeasureKindInfo& kind : measure_kinds())
      every.variants.push_back(of_kind(kind, every));
    return every;
  }();
  return info;
}

const BlockInfo& measure_at_block() {
  static const BlockInfo info{"measure.at",
                              "A height; one of the two.",
                              {{"z", "position on the z axis", {number("m")}, ""},
                               {"from_lower_end",
                                "distance from the body's lower end at the time of measuring",
                                {number("m", Range::non_negative)},
                                ""}}};
  return info;
}

const BlockInfo& measure_within_block() {
  static const BlockInfo info{"measure.within",
                              "Heights near the body's lower end.",
                              {{"from_lower_end",
                                "greatest distance from the body's lower end",
                                {number("m", Range::positive)},
                                kMust}}};
  return info;
}

const BlockInfo& references_block() {
  static const BlockInfo info{"references",
                              "Values of measures that are known from elsewhere.",
                              {{"*", "the name of a measure", {block(reference_block)}, ""}}};
  return info;
}

const BlockInfo& reference_block() {
  static const BlockInfo info{"reference",
                              "What a measure should be, and who says so.",
                              {{"value", "what the measure should be", {number("")}, kMust},
                               {"error",
                                "half the bar that the source gives, or the scatter of its tests",
                                {number("", Range::positive)},
                                "(not known)"},
                               {"source", "where the value is from", {text()}, "(nothing)"}}};
  return info;
}

const BlockInfo& outcome_block() {
  static const BlockInfo info{
      "outcome",
      "What became of a projectile.",
      {{"projectile", "the body whose fate is asked", {text()}, kMust},
       {"target", "the body that it meets", {text()}, kMust},
       {"tolerance",
        "of the change of velocity, that counts as no change any more",
        {number("1", Range::positive)},
        "0.01"},
       {"every", "time between looks", {number("s", Range::non_negative)}, "(time.end / 200)"}}};
  return info;
}

const BlockInfo& gauge_block() {
  static const BlockInfo info{
      "gauge",
      "A record at times of its own: fields at places of a body, or measures of the scene.",
      {{"measures", "of the scene's measures, each also with _rate", {list({text()}, 1)}, ""},
       {"body", "the body whose points it reads; or measures: [...]", {text()}, kWhereUsed},
       {"fixed", "a place in space, instead of a point of the material", {flag()}, "false"},
       {"section", "a normal: reads the plane cut through each place", {text(), vector("1")}, ""},
       {"at", "a place", {vector("m")}, ""},
       {"from", "first place of a line", {vector("m")}, ""},
       {"to", "last place of a line", {vector("m")}, ""},
       {"count", "places along the line", {integer(2, 1000)}, "2"},
       {"fields",
        "velocity_z, stress_zz, speed, pressure_rate, ...; of sections also area, force_z",
        {list({text()}, 1)},
        kWhereUsed},
       {"every", "time between samples", {number("s", Range::positive)}, "(time.end / 1000)"},
       {"filter", "a filtered record beside the raw one", {block(filter_block)}, ""}}};
  return info;
}

const BlockInfo& filter_block() {
  static const BlockInfo info{
      "gauge.filter",
      "A filter.",
      {{"butterworth",
        "two poles both ways, -3 dB at this frequency",
        {number("Hz", Range::positive)},
        ""},
       {"cfc",
        "channel frequency class of SAE J211: the same at 5/3 of it in Hz",
        {number("1", Range::positive)},
        ""},
       {"moving_mean", "mean over this time", {number("s", Range::positive)}, ""}},
      true};
  return info;
}

}  // namespace krater::scene
