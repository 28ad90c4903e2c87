// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of every law in ns per point and update: `tools/bench laws` builds, runs and prints it.
//
// A patch of 512 points in runs of 8 lane groups, as the step hands them over, in cache. Every
// repetition starts from the same saved state, elastic (no point yields) or plastic (every point
// yields, in developed flow); stages are timed one by one on each run. Medians over repetitions.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "bench/calibration.hpp"
#include "contract/material_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr int kPoints = 512, kBatch = 64;
constexpr double kStep = 1e-8;

struct Case {
  std::string group;  ///< what the row is about: "strength: voce"
  Recipe recipe;
};

/// The target of the project first, then each family with the others held fixed.
std::vector<Case> cases() {
  const Recipe base{.strength = "johnson_cook", .eos = "mie_gruneisen_shock", .heating = true};
  std::vector<Case> all{{"target: Johnson-Cook, shock eos, viscosity, plastic heating", base}};
  for (const LawInfo& law : catalogue()) {
    Recipe r = base;
    const std::string group = law.family + ": " + law.name;
    if (law.family == "strength") {
      r.strength = law.name, r.heating = law.yields;
      if (law.whole_stress) r.eos = "";
      all.push_back({group, r});
    } else if (law.family == "eos") {
      r.eos = law.name;
      all.push_back({group, r});
    } else if (law.family == "model") {
      r.strength = r.eos = "", r.model = law.name;
      all.push_back({group, r});
    } else if (law.family == "heating" && law.needs_eos) {
      r.heating = false, r.thermal = true;
      all.push_back({group, r});
    } else if (law.family == "damage") {
      r.damage = law.name;
      const auto values = typical_parameters(law);
      all.push_back({group, r});
      if (!law_degrades(find_law("damage", law.name), values.data(), kCopper)) continue;
      r.coupling = Coupling::rate;
      all.push_back({group + " (coupling rate)", r});
    }
  }
  for (int i = 1; i < 4; ++i) {
    Recipe r = base;
    r.rate = static_cast<Rate>(i);
    all.push_back({std::string{"rate: "} + kRateNames[i], r});
  }
  Recipe spall = base;
  spall.spall_strength = 2e9;
  all.push_back({"spall_strength", spall});
  return all;
}

/// Shear and compression that differ from point to point, the same in every step.
void set_flow(Body& body, double size) {
  for (int i = 0; i < body.points(); ++i) {
    for (int k = 0; k < 9; ++k)
      body.local("step_gradient", i, k) =
          size * (0.3 * std::sin(1.3 * i + k) + (k == 1 ? 1.0 : 0.0));
    body.local("extra_dilatation", i) = 0.01 * size * std::cos(0.7 * i);
  }
}

struct Timing {
  std::vector<double> stages;  ///< [ns per point]
  double total = 0;            ///< of all stages in one go
  double yielding = 0;         ///< share of the points
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Share of the points whose plastic strain grows in a step.
double share_yielding(Body& body) {
  if (body.layout().find("plastic_strain") == nullptr) return 0;
  std::vector<double> before;
  for (int i = 0; i < body.points(); ++i) before.push_back(body.state("plastic_strain", i));
  body.step(kStep);
  double count = 0;
  for (int i = 0; i < body.points(); ++i)
    if (body.state("plastic_strain", i) > before[static_cast<std::size_t>(i)]) count += 1;
  return count / body.points();
}

Timing measure(const StageFactory& factory, const Recipe& recipe, bool plastic, int repetitions) {
  Body body{factory, recipe, kPoints, kBatch};
  set_flow(body, plastic ? 1e-3 : 1e-7);
  for (int n = 0; n < (plastic ? 12 : 4); ++n) body.step(kStep);
  const std::vector<double> saved = body.storage();
  Timing result;
  result.yielding = share_yielding(body);
  const std::size_t count = body.stages().size();
  std::vector<std::vector<double>> samples(count);
  std::vector<double> totals;
  const double scale = 1e9 * bench::seconds_per_tick() / kPoints;
  const auto restore = [&] { std::copy(saved.begin(), saved.end(), body.storage().begin()); };
  for (int r = 0; r < repetitions; ++r) {
    restore();
    unsigned long long start = bench::ticks();
    for (int b = 0; b < body.batches(); ++b) {
      const BatchData batch = body.batch(b, kStep);
      for (const NamedStage& stage : body.stages()) stage.stage->apply(batch);
    }
    totals.push_back(static_cast<double>(bench::ticks() - start) * scale);
    restore();
    std::vector<double> spent(count, 0.0);
    for (int b = 0; b < body.batches(); ++b) {
      const BatchData batch = body.batch(b, kStep);
      for (std::size_t k = 0; k < count; ++k) {
        start = bench::ticks();
        body.stages()[k].stage->apply(batch);
        spent[k] += static_cast<double>(bench::ticks() - start) * scale;
      }
    }
    for (std::size_t k = 0; k < count; ++k) samples[k].push_back(spent[k]);
  }
  for (const auto& s : samples) result.stages.push_back(median(s));
  result.total = median(totals);
  return result;
}

void print_timing(const Case& c, const Level& level, bool plastic, const Timing& t, bool first) {
  const Body names{*level.factory, c.recipe, 1, 1};
  std::printf(
      "%s\n    {\"case\": \"%s\", \"level\": \"%s\", \"state\": \"%s\", \"yielding\": %.3f, "
      "\"ns\": %.3f, \"stages\": {",
      first ? "" : ",", c.group.c_str(), level.name, plastic ? "plastic" : "elastic", t.yielding,
      t.total);
  for (std::size_t k = 0; k < t.stages.size(); ++k)
    std::printf("%s\"%s\": %.3f", k == 0 ? "" : ", ", names.stages()[k].name.c_str(), t.stages[k]);
  std::printf("}}");
}

}  // namespace

/// krater_bench_laws [REPETITIONS] [PART]: JSON on stdout; PART keeps cases whose name contains it.
int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 201;
  const std::string part = argc > 2 ? argv[2] : "";
  if (repetitions < 1) {
    std::fprintf(stderr, "krater_bench_laws: REPETITIONS must be a positive number\n");
    return 2;
  }
  std::printf("{\n  \"points\": %d, \"batch\": %d, \"repetitions\": %d,\n  \"calibration\": {",
              kPoints, kBatch, repetitions);
  std::printf("\"clock_hz\": %.4g, \"fma_flops\": {", bench::clock_rate());
  const std::vector<Level> all = levels();
  for (std::size_t i = 0; i < all.size(); ++i)
    std::printf("%s\"%s\": %.4g", i == 0 ? "" : ", ", all[i].name, bench::fma_rate_of(all[i].name));
  std::printf("}},\n  \"rows\": [");
  bool first = true;
  for (const Case& c : cases()) {
    if (c.group.find(part) == std::string::npos) continue;
    for (const Level& level : all) {
      for (const bool plastic : {false, true}) {
        const Timing t = measure(*level.factory, c.recipe, plastic, repetitions);
        print_timing(c, level, plastic, t, first);
        first = false;
      }
    }
    std::fprintf(stderr, "%s\n", c.group.c_str());
  }
  std::printf("\n  ],\n  \"clock_hz_after\": %.4g\n}\n", bench::clock_rate());
  return 0;
}
