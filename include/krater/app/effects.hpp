// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/effects.hpp
/// What a scene computes beside moving its points: one row per effect and material, with the line
/// that calls for it, what it costs, what it did in the last ablation of the scene, and advice.
///
///     bytes per point        columns of the body less those of the body without the effect
///     ns per point and step  stages of the one less those of the other (simulation/stage_timer)
///     influence              greatest change of a measure without it: DIR/influence.tsv of a
///                            `krater study` of kind ablation beside scene or results
///     advice                 what the speed of the impact lets expect (app/effect_advice.cpp)
///
/// "Without" strength means elastic, without an equation of state linear, without a rate truesdell.
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "krater/output/results.hpp"
#include "krater/scene/scene.hpp"
#include "krater/simulation/stage_timer.hpp"

namespace krater {

enum class EffectKind { strength, eos, model, rate, viscosity, heating, damage, spall, contact };
inline constexpr const char* kEffectNames[] = {"strength", "eos",    "model", "rate",   "viscosity",
                                               "heating",  "damage", "spall", "contact"};

struct Effect {
  EffectKind kind;
  int material = -1;           ///< -1: of the scene
  std::string law{};           ///< empty: the scene does not ask for it
  std::string key{}, where{};  ///< materials.copper.heating; taylor.yaml:31
  double bytes = std::numeric_limits<double>::quiet_NaN();
  double nanoseconds = std::numeric_limits<double>::quiet_NaN();
  std::string influence{};  ///< empty: no ablation is known
  std::string word{};       ///< advice in two words; empty: none
  bool on() const { return !law.empty(); }
  const char* name() const { return kEffectNames[static_cast<int>(kind)]; }
};

/// How the bodies meet, by their velocities at the start.
struct Impact {
  double fastest = 0;  ///< greatest speed of a body, or of a side of the domain [m/s]
  double closing = 0;  ///< greatest speed at which a body meets another, its image or a side [m/s]
  /// Loads, explosives or pressures at the start move something: speeds do not tell what comes.
  bool driven = false;
};
Impact impact_of(const Scene& scene);

/// Of all materials whose bodies deform, on or off.
std::vector<Effect> effects_of(const Scene& scene);

/// Sets the words of the effects; returns the sentences, each with its number and its reason.
std::vector<std::string> advise(const Scene& scene, std::vector<Effect>& effects);

/// Influence from the last ablation that lies beside the scene, the results (empty: none) or here.
void add_influence(const Scene& scene, const std::string& results, std::vector<Effect>& effects);

/// The cost of each effect, from timers that a run may feed with samples of its points.
class EffectCosts {
 public:
  EffectCosts(const Scene& scene, IsaLevel level);
  /// Looks at some points, a few times in a run.
  void look(const Simulation& sim);
  void fill(std::vector<Effect>& effects) const;
  /// All stages of the material's first body [ns per point and step]; NaN before the first look.
  double stages(int material) const;

 private:
  struct Timer {
    int material;
    std::shared_ptr<StageTimer> timer;
  };
  struct Pair {
    EffectKind kind;
    int material;
    std::shared_ptr<StageTimer> with, without;
  };
  void compare(const Effect& effect, IsaLevel level);
  std::shared_ptr<StageTimer> add_timer(const Scene& scene, int material, IsaLevel level);
  const Scene& scene_;
  std::vector<Timer> timers_;  ///< the first of a material is that of the scene as it is
  std::vector<Pair> pairs_;
  double next_ = 0;  ///< [s]
  std::int64_t turn_ = 0;
};

/// Everything that is told of effects.
struct EffectReport {
  std::vector<Effect> effects;
  std::vector<double> stages;  ///< by material, all of them [ns per point and step]
  double step = std::numeric_limits<double>::quiet_NaN();  ///< all that a step does [ns per point]
  std::vector<std::string> sentences;
};
/// `results`: the folder of a run, whose neighbours may hold an ablation; empty: none.
EffectReport report_effects(const Scene& scene, const EffectCosts& costs,
                            const std::string& results);
/// The same with the times of the phases of a run: of all its threads.
EffectReport report_run(const Simulation& sim, const EffectCosts& costs, const std::string& results,
                        double point_steps);

/// The table for people, and the same for scripts: without times, which are the machine's.
std::vector<std::string> effect_table(const Scene& scene, const EffectReport& report);
Json effects_json(const Scene& scene, const EffectReport& report);
Json effect_times_json(const Scene& scene, const EffectReport& report);

}  // namespace krater
