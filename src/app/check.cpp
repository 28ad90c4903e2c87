// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "krater/app/card_doctor.hpp"
#include "krater/app/command_line.hpp"
#include "krater/app/run.hpp"
#include "krater/app/simulation.hpp"

namespace krater {

namespace {

// Point-steps per second and core of this code on a 2020s server core, for the estimate of the
// run's time only.
constexpr double kRate2d = 12e6, kRate3d = 6e6;

void print_body(const Simulation& sim, const Body& body, int index) {
  const FillReport& f = body.fill_report();
  const Totals t = sim.totals(index);
  fmt::print(
      "body {}: material {}, {:.0f} points, mass {:.6g} kg (points {:.6g}), thinnest {:.1f} "
      "cells\n",
      body.name(), body.material().name, t.count, f.measure_exact * body.material().density, t.mass,
      f.smallest_thickness_in_cells);
  fmt::print("  stages:");
  for (const NamedStage& s : body.stages()) fmt::print(" {};", s.name);
  fmt::print("\n  columns ({} bytes per point):", body.layout().stride());
  for (const Column& c : body.layout().columns())
    fmt::print(" {}{}", c.field->name, c.components > 1 ? fmt::format("[{}]", c.components) : "");
  fmt::print("\n");
}

/// The largest speed at which a body meets another, its mirror image in a symmetry plane, or a
/// moving plane, by the bodies' mean velocities; at least the speed of the fastest (walls, still
/// targets).
double closing_speed(const Simulation& sim, double fastest) {
  double closing = fastest;
  const auto mean_velocity = [&](std::size_t body) {
    const Totals t = sim.totals(static_cast<int>(body));
    Triple v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = t.mass > 0 ? t.momentum[k] / t.mass : 0;
    return v;
  };
  for (std::size_t a = 0; a < sim.bodies().size(); ++a) {
    const Triple v = mean_velocity(a);
    for (std::size_t b = 0; b < a; ++b) {
      const Triple w = mean_velocity(b);
      closing = std::max(closing, std::hypot(v[0] - w[0], v[1] - w[1], v[2] - w[2]));
    }
    for (std::size_t k = 0; k < 3; ++k)
      for (const Boundary& plane : sim.scene().grid.boundary[k]) {
        if (plane.kind == BoundaryKind::symmetry) closing = std::max(closing, 2 * std::fabs(v[k]));
        if (plane.kind == BoundaryKind::velocity)
          closing = std::max(closing, std::fabs(v[k] - plane.velocity[k]));
      }
  }
  return closing;
}

/// Impact regime by velocity and stress (BUSH, after Zukas): what a scene of this speed needs.
void print_advice(const Scene& scene, double fastest, double closing) {
  for (const MaterialOptions& m : scene.materials) {
    if (fastest > 500 && m.eos && m.eos->name == "linear")
      fmt::print(
          "advice: {}: {:.0f} m/s with a linear equation of state; shocks need "
          "mie_gruneisen_shock\n",
          m.name, fastest);
    if (fastest > 50 && !m.viscosity)
      fmt::print("advice: {}: no viscosity block; shocks will ring (add viscosity: {{}})\n",
                 m.name);
    if (fastest > 100 && m.eos && !m.spall_strength && !m.damage)
      fmt::print("advice: {}: neither spall_strength nor damage; cold tension has no other limit\n",
                 m.name);
    if (fastest > 100 && m.strength && m.strength->name == "johnson_cook" && !m.heating)
      fmt::print("advice: {}: johnson_cook without heating: no thermal softening\n", m.name);
    if (closing > 2000 && m.heating && m.heating->name == "plastic_work")
      fmt::print(
          "advice: {}: impact at {:.0f} m/s: plastic_work misses the heat of the shock (theory 8); "
          "heating: {{energy: {{c_v: ...}}}} sees it\n",
          m.name, closing);
  }
}

}  // namespace

void print_check(const RunOptions& options) {
  const Scene scene = read_scene(options.scene, options.overrides);
  for (const std::string& note : scene.notes) fmt::print("note: {}\n", note);
  const Simulation sim{scene};
  fmt::print("{}\nframe {}, cell {:g} m, {} blocks\n",
             scene.title.empty() ? options.scene : scene.title, name(scene.frame), scene.grid.cell,
             sim.block_count());
  double fastest = 0, signal = 0;
  for (std::size_t b = 0; b < sim.bodies().size(); ++b) {
    print_body(sim, *sim.bodies()[b], static_cast<int>(b));
    const Totals t = sim.totals(static_cast<int>(b));
    fastest = std::max(fastest, t.mass > 0 ? std::sqrt(2 * t.kinetic / t.mass) : 0);
    signal = std::max(signal, sim.bodies()[b]->initial_sound_speed());
  }
  const double steps =
      scene.time.end * (fastest + 1.35 * signal) / (scene.time.cfl * scene.grid.cell);
  const double work = steps * static_cast<double>(sim.point_count());
  fmt::print("estimate: {:.0f} steps, {:.0f} MB, {:.1f} s on one core\n", steps,
             1e-6 * sim.bytes_per_point() * static_cast<double>(sim.point_count()),
             work / (dimension(scene.frame) == 3 ? kRate3d : kRate2d));
  print_advice(scene, fastest, closing_speed(sim, fastest));
  for (const MaterialOptions& m : scene.materials)
    for (const std::string& key : m.unused)
      fmt::print("note: {}: its card holds {}, which this scene does not use ({}: card)\n", m.name,
                 key, key);
  for (const MaterialOptions& m : scene.materials)
    for (const std::string& doubt : examine(m)) fmt::print("doubt: {}: {}\n", m.name, doubt);
}

}  // namespace krater
