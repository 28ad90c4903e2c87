// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/forecast.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/core/ranks.hpp"
#include "krater/core/stability.hpp"
#include "krater/kinematics/mpm/kernel_levels.hpp"
#include "krater/measure/measurements.hpp"
#include "krater/simulation/body.hpp"

namespace krater {

namespace {

// Measured on one core of a 2020s server, single precision of such figures: a factor of two.
constexpr double kRate2d = 12e6, kRate3d = 6e6;  // point-steps per second
constexpr double kSetup = 2.5e-6;                // seconds per point
constexpr double kRow = 6e-8;                    // seconds per point, row of history and measure
constexpr double kWrite = 1e-8;                  // seconds per byte of frames and checkpoints
constexpr double kFile = 5e-3;                   // seconds per frame, however small
// Bytes: of a point beside its columns (patch, tile, nodes), of a lattice cell of the body's box
// and of a seed while points are made, of a frame file's structure, of a number in the history (csv
// and h5), of the program.
constexpr double kBesides = 77, kCell = 12, kSeed = 130, kFrameFile = 16e3, kHistoryValue = 28;
constexpr double kProgram = 40e6;
constexpr double kCopies = 2.1;      // of the columns, while frames and checkpoints are written
constexpr double kDerived = 8;       // numbers of a frame beside the columns: stress, places
constexpr double kColumns = 40;      // of the history
constexpr double kShock = 1.35;      // sound speeds: edges, viscosity and a moderate shock
constexpr double kMostSteps = 1e12;  // years for a single point

/// Lattice cells of the body's box, of which the filler keeps a table.
double box_cells(const Scene& scene, const BodyOptions& body) {
  const int dim = dimension(scene.frame);
  const Box box = intersection(body.solid->extent(scene.frame), domain_box(scene), dim);
  double cells = 1;
  for (int a = 0; a < dim; ++a) {
    const int per = body.points.per_direction[static_cast<std::size_t>(a)];
    cells *= std::max(0.0, box.length(a)) / scene.grid.cell * per + 1;
  }
  return cells;
}

/// Steps of a run and how many of them output times cut.
void count_steps(const Scene& scene, double rate, Forecast& out) {
  const TimeOptions& time = scene.time;
  double dt = rate > 0 ? time.cfl / rate : time.end;
  if (time.max_step > 0) dt = std::min(dt, time.max_step);
  dt = std::min(dt, time.end);
  const double free = std::ceil(time.end / dt * (1 - 1e-9));
  out.frames = 1;
  out.steps = free;
  if (scene.output.frames > 0) {
    const double interval = std::min(scene.output.frames, time.end);
    out.frames = std::ceil(time.end / interval * (1 - 1e-9));
    out.steps = out.frames * std::ceil(interval / dt * (1 - 1e-9));
  }
  out.cut_steps = out.steps - free;
}

}  // namespace

std::vector<Triple> sampled_velocities(const Scene& scene, const BodyOptions& body) {
  if (!body.velocity) return {Triple{}};
  std::vector<Triple> out;
  const int dim = dimension(scene.frame);
  const Box box = intersection(body.solid->extent(scene.frame), domain_box(scene), dim);
  for (int n = 0; n < (dim == 3 ? 27 : 9); ++n) {
    Triple x{};
    int digits = n;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
      x[a] = box.min[a] + (0.01 + 0.49 * (digits % 3)) * (box.max[a] - box.min[a]);
      digits /= 3;
    }
    out.push_back((*body.velocity)(x, x, 0));
  }
  return out;
}

double greatest_speed(const Scene& scene, const BodyOptions& body) {
  double fastest = 0;
  for (const Triple& v : sampled_velocities(scene, body)) {
    const double speed = std::hypot(v[0], v[1], v[2]);
    if (std::isfinite(speed)) fastest = std::max(fastest, speed);
  }
  return fastest;
}

Forecast forecast(const Scene& scene) {
  Forecast out;
  double signal = 0, fastest = 0, making = 0, holding = 0, frame = kFrameFile, columns = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body body{scene, static_cast<int>(b), stage_factory(best_isa_level())};
    const double n = body.options().point_estimate, state = body.layout().stride();
    signal = std::max(signal, body.initial_sound_speed());
    fastest = std::max(fastest, greatest_speed(scene, body.options()));
    out.points += n;
    making = std::max(making, kCell * box_cells(scene, body.options()) + kSeed * n);
    holding += n * (state + kBesides);
    columns += n * state;
    frame += n * (state + 8 * kDerived);
  }
  for (const auto& axis : scene.grid.boundary)
    for (const Boundary& side : axis)
      for (const double v : side.velocity) fastest = std::max(fastest, std::fabs(v));
  out.memory = kProgram + holding + std::max(making, kCopies * columns);
  const double cell = std::ldexp(scene.grid.cell, -scene.grid.finest());
  count_steps(scene, std::max(fastest / kMostTravel, kShock * signal) / cell, out);
  const double every = scene.output.history;
  const double rows = std::min(out.steps, every > 0 ? scene.time.end / every : out.steps) + 1;
  double measures = 1;
  for (const MeasureOptions& m : scene.measures) measures += m.in_history ? 1 : 0;
  out.results = (out.frames + 1) * frame + columns + rows * (kColumns + measures) * kHistoryValue;
  out.setup = kSetup * out.points;
  out.stepping = out.steps * out.points / (dimension(scene.frame) == 3 ? kRate3d : kRate2d);
  out.writing = rows * measures * kRow * out.points + (out.frames + 1) * (kFile + kWrite * frame) +
                kWrite * columns;
  return out;
}

namespace {

/// Of the ranks on this machine [bytes]: their shares, what each of them walks through at the
/// start, and with the first of them all points, where measures look at them.
double memory_here(const Scene& scene, const Forecast& f) {
  if (ranks::alone()) return f.memory;
  const double here = ranks::on_this_machine();
  const bool all = ranks::first() && (looks_at_points(scene) || looks_on_its_own(scene));
  return f.memory * (here / ranks::count() + (all ? 1 : 0)) + kSeed * f.points * here;
}

}  // namespace

void require_feasible(const Scene& scene, const Forecast& f) {
  const Memory there = memory();
  const double needed = memory_here(scene, f);
  if (needed > there.available) {
    const double factor = std::pow(needed / there.available, 1.0 / dimension(scene.frame));
    throw InputError(fmt::format(
        "{}: {} points need {} of memory{}, and {} are {}; use a larger grid.cell (about {:.2g} "
        "m), "
        "fewer points_per_direction or smaller bodies",
        scene.grid.where, count_text(f.points), bytes_text(needed),
        ranks::alone()
            ? ""
            : fmt::format(" for {} of {} ranks here", ranks::on_this_machine(), ranks::count()),
        bytes_text(there.available), there.limit, scene.grid.cell * std::min(factor, 1e3)));
  }
  if (f.steps <= kMostSteps) return;
  const std::string cause = f.cut_steps > 0.5 * f.steps ? "output.frames cuts them short: use a "
                                                          "longer interval"
                            : scene.time.max_step > 0   ? "use a longer time.max_step"
                                                      : "use a shorter time.end, a larger cfl or a "
                                                        "larger grid.cell";
  throw InputError(fmt::format("{}: about {} steps, {} on one core; {}", scene.time.where,
                               count_text(f.steps), duration_text(f.seconds()), cause));
}

std::string duration_text(double seconds) {
  struct Unit {
    double length;
    const char* name;
  };
  constexpr std::array<Unit, 5> units{
      {{365.25 * 86400, "years"}, {86400, "days"}, {3600, "h"}, {60, "min"}, {1, "s"}}};
  for (const Unit& unit : units) {
    const double value = seconds / unit.length;
    if (value < 2 && unit.length > 1) continue;
    return fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, unit.name);
  }
  return "";
}

std::string bytes_text(double bytes) {
  const bool small = bytes < 9.5e8;
  const double value = (small ? 1e-6 : 1e-9) * bytes;
  return fmt::format("{:.{}f} {}", value, value < 9.95 ? 1 : 0, small ? "MB" : "GB");
}

std::string count_text(double count) {
  if (count < 1e6) return fmt::format("{:.0f}", count);
  if (count < 1e9) return fmt::format("{:.3g} million", 1e-6 * count);
  return fmt::format("{:.3g}", count);
}

}  // namespace krater
