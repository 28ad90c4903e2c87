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
  double cell = 0, points = 0, bytes = 0, blocks = 0;
};

/// All levels take the same steps, so a level's share of the time is that of its points.
struct LevelAccount {
  std::map<int, LevelCount> levels;
  double points = 0, uniform = 0;  ///< of all levels; if all cells were of the finest
  double finest = 0;               ///< cell [m]
};

LevelAccount account(const Simulation& sim, int coarser) {
  LevelAccount out;
  const int dim = sim.geometry().dimension;
  const double times = std::pow(coarser, dim);
  for (const Patch& patch : sim.grid().patches()) {
    LevelCount& count = out.levels[patch.key.level];
    count.cell = sim.grid().geometry(patch.key.level).h / coarser;
    count.points += times * patch.count();
    count.bytes +=
        times * 8.0 * static_cast<double>(patch.points.capacity() + patch.tile.nodes.size());
    count.blocks += times;
  }
  if (out.levels.empty()) return out;
  const int finest = out.levels.rbegin()->first;
  out.finest = out.levels.rbegin()->second.cell;
  for (const auto& [level, count] : out.levels) {
    out.points += count.points;
    out.uniform += count.points * std::pow(corner_count(dim), finest - level);
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

std::vector<std::string> report_levels(const Simulation& sim, int coarser) {
  std::vector<std::string> out;
  const LevelAccount all = account(sim, coarser);
  if (sim.scene().grid.refine.empty() || all.levels.empty()) return out;
  for (const auto& [level, count] : all.levels)
    out.push_back(
        fmt::format("level {}: cell {:.4g} m, {} points in {:.0f} blocks, {}, {:.0f} % of the time",
                    level, count.cell, count_text(count.points), count.blocks,
                    bytes_text(count.bytes), 100 * count.points / all.points));
  out.push_back(fmt::format(
      "levels: cells of {:.4g} m everywhere would be {} points, {:.3g} times as many; all levels "
      "take the step of the finest",
      all.finest, count_text(all.uniform), all.uniform / all.points));
  return out;
}

Json levels_json(const Simulation& sim, int coarser) {
  const LevelAccount all = account(sim, coarser);
  Json list = Json::array();
  for (const auto& [level, count] : all.levels) {
    Json& entry = list.items.emplace_back();
    entry["level"] = Json::of(level);
    entry["cell"] = Json::of(count.cell);
    entry["points"] = Json::of(count.points);
    entry["blocks"] = Json::of(count.blocks);
    entry["bytes"] = Json::of(count.bytes);
    entry["share_of_time"] = Json::of(count.points / all.points);
  }
  Json out;
  out["list"] = list;
  out["uniform_points"] = Json::of(all.uniform);
  out["saving"] = Json::of(all.points > 0 ? all.uniform / all.points : 1);
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
