// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/level_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "krater/app/forecast.hpp"

namespace krater {

namespace {

constexpr double kFewCells = 4;  ///< through a body: fewer do not bend as they should

struct LevelCount {
  double points = 0, bytes = 0;
  int blocks = 0;
};

std::map<int, LevelCount> count_levels(const Simulation& sim) {
  std::map<int, LevelCount> out;
  for (const Patch& patch : sim.grid().patches()) {
    LevelCount& count = out[patch.key.level];
    count.points += patch.points.count();
    count.bytes += 8.0 * static_cast<double>(patch.points.capacity() + patch.tile.nodes.size());
    count.blocks += 1;
  }
  return out;
}

const std::string& name_of(const Simulation& sim, int body) {
  return sim.bodies()[static_cast<std::size_t>(body)]->name();
}

/// Pairs of fields that share nodes on more than one level.
void doubt_joints(const Simulation& sim, std::vector<std::string>& out) {
  std::map<std::pair<int, int>, std::set<int>> levels;
  const std::vector<NodeBlock>& blocks = sim.grid().node_blocks();
  for (std::size_t n = 0; n < blocks.size(); ++n)
    for (std::size_t k = n + 1; k < blocks.size() && blocks[k].key == blocks[n].key; ++k)
      if (blocks[n].tiles > 0 && blocks[k].tiles > 0)
        levels[{body_of(blocks[n].field), body_of(blocks[k].field)}].insert(blocks[n].key.level);
  for (const auto& [pair, of] : levels)
    if (of.size() > 1)
      out.push_back(fmt::format(
          "{} and {} are near each other among cells of {} levels: contact begins at a gap of 0.05 "
          "cells, so an edge of finer cells across their joint pushes one end first; let "
          "grid.refine hold the whole joint (follow one of them with a margin)",
          name_of(sim, pair.first), name_of(sim, pair.second), of.size()));
}

/// Bodies that stand at a side that pushes, on more than one level.
void doubt_feet(const Simulation& sim, std::vector<std::string>& out) {
  const GridGeometry& g = sim.geometry();
  for (int axis = 0; axis < g.dimension; ++axis)
    for (const int side : {0, 1}) {
      const auto a = static_cast<std::size_t>(axis);
      const Boundary& plane = sim.scene().grid.boundary[a][static_cast<std::size_t>(side)];
      if (!plane.pushes()) continue;
      std::map<int, std::set<int>> levels;
      for (const Patch& patch : sim.grid().patches()) {
        const Box box = box_of(sim.grid().geometry(patch.key.level), patch.key);
        const double apart = side == 0 ? box.min[a] - g.min[a] : g.upper(axis) - box.max[a];
        if (apart < 0.5 * g.h) levels[patch.body].insert(patch.key.level);
      }
      for (const auto& [body, of] : levels)
        if (of.size() > 1)
          out.push_back(fmt::format(
              "{} stands at the side {}_{} among cells of {} levels: the wall is touched at a gap "
              "of a third of a coarse cell and a sixth of a fine one, so a body that flies there "
              "is turned; let grid.refine hold the whole foot",
              name_of(sim, body), axis_name(sim.scene().frame, axis), side == 0 ? "min" : "max",
              of.size()));
    }
}

void doubt_thickness(const Simulation& sim, std::vector<std::string>& out) {
  for (const auto& body : sim.bodies()) {
    if (!body->options().material_points() || body->options().rigid()) continue;
    const double cells = body->thickness() / body->seed_cell();
    if (cells < kFewCells * (1 - 1e-9))
      out.push_back(fmt::format(
          "{} is {:.2g} cells thick where these are coarse: it does not bend there as it should; "
          "a smaller grid.cell, or a rule of grid.refine that holds it",
          body->name(), cells));
  }
}

}  // namespace

std::vector<std::string> report_levels(const Simulation& sim) {
  const Scene& scene = sim.scene();
  std::vector<std::string> out;
  if (scene.grid.refine.empty()) return out;
  const std::map<int, LevelCount> levels = count_levels(sim);
  double all = 0, uniform = 0;
  const int finest = levels.empty() ? 0 : levels.rbegin()->first;
  for (const auto& [level, count] : levels) {
    all += count.points;
    uniform += count.points * std::pow(corner_count(sim.geometry().dimension), finest - level);
  }
  for (const auto& [level, count] : levels)
    out.push_back(
        fmt::format("level {}: cell {:.4g} m, {} points in {} blocks, {}, {:.0f} % of the time",
                    level, sim.grid().geometry(level).h, count_text(count.points), count.blocks,
                    bytes_text(count.bytes), 100 * count.points / all));
  out.push_back(fmt::format(
      "levels: cells of {:.4g} m everywhere would be {} points, {:.3g} times as many; all levels "
      "take the step of the finest",
      sim.grid().geometry(finest).h, count_text(uniform), uniform / all));
  return out;
}

std::vector<std::string> doubt_levels(const Simulation& sim) {
  std::vector<std::string> out;
  if (sim.scene().grid.refine.empty()) return out;
  doubt_joints(sim, out);
  doubt_feet(sim, out);
  doubt_thickness(sim, out);
  return out;
}

}  // namespace krater
