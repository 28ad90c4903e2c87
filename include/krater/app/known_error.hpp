// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/known_error.hpp
/// What an earlier `krater study` (convergence) or `krater run --accuracy` found of this scene's
/// numerical errors. They leave DIR/uncertainty.tsv; it is looked for in the folders beside the
/// results, the scene and the current one. A band belongs to a value: it is believed where cell and
/// value are the same as here, so that no other version of scene or program passes for this one.
#include <string>
#include <vector>

#include "krater/output/results.hpp"

namespace krater {

struct FinishedRun {
  std::string scene, folder;  ///< file, results folder
  double cell = 0;            ///< [m]
  double seconds = 0;         ///< of wall time
};

/// Adds `uncertainty` and `uncertainty_from` to the measures of `summary`; returns lines to be
/// told: every band that is known, and what it costs to know the rest.
std::vector<std::string> add_known_errors(const FinishedRun& run, Json& summary);

}  // namespace krater
