// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/compare.hpp
/// Two scenes compared key by key in their resolved form, where every default is written out.
#include <string>
#include <vector>

namespace krater {

struct SceneDifference {
  std::string path;         ///< materials.copper.density
  std::string before, now;  ///< values; "none" where there is no such key
};

/// Differences of two resolved scenes (Scene::resolved). The order of keys means nothing.
std::vector<SceneDifference> scene_differences(const std::string& before, const std::string& now);

/// True for keys that a continued run may change: when it ends, how its time step is limited, what
/// it writes and measures. All others make up the state that a checkpoint holds.
bool may_differ(const SceneDifference& difference);

/// The measures among the keys that differ.
std::vector<std::string> changed_measures(const std::vector<SceneDifference>& differences);

}  // namespace krater
