// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "krater/app/card_doctor.hpp"
#include "krater/app/command_line.hpp"
#include "krater/app/field_doubts.hpp"
#include "krater/app/folder_lock.hpp"
#include "krater/app/run.hpp"
#include "krater/app/simulation.hpp"
#include "krater/app/snapshot.hpp"
#include "krater/app/version.hpp"
#include "krater/core/parallel.hpp"
#include "krater/geometry/column.hpp"

namespace krater {

namespace {

// Point-steps per second and core of this code on a 2020s server core, for the estimate of the
// run's time only.
constexpr double kRate2d = 12e6, kRate3d = 6e6;

const char* unit_of(Frame frame) { return frame == Frame::plane_strain ? "m^3 (1 m of y)" : "m^3"; }

/// The body as drawn, in the domain, and what its points make of it.
void print_shape(const Scene& scene, const Body& body) {
  bool exact = false;
  const VolumeMoments solid =
      moments_in(*body.options().solid, scene.frame, domain_box(scene), &exact);
  const VolumeMoments& points = body.seed_moments();
  const double rho = body.material().density;
  const Triple c = solid.centroid(), p = points.centroid();
  const auto i = solid.inertia(), j = points.inertia();
  fmt::print(
      "  solid ({}): volume {:.6g} {}, mass {:.6g} kg, centroid ({:.5g}, {:.5g}, {:.5g}) m\n",
      exact ? "closed form" : "quadrature", solid.volume, unit_of(scene.frame), rho * solid.volume,
      c[0], c[1], c[2]);
  fmt::print(
      "    inertia about it: xx {:.5g}, yy {:.5g}, zz {:.5g}, yz {:.3g}, xz {:.3g}, xy {:.3g} "
      "kg m^2\n",
      rho * i[0], rho * i[1], rho * i[2], rho * i[3] + 0.0, rho * i[4] + 0.0, rho * i[5] + 0.0);
  const auto percent = [](double a, double b) { return 100 * (a / b - 1); };
  fmt::print(
      "  points - solid: mass {:+.4f} %, centroid ({:+.2g}, {:+.2g}, {:+.2g}) cells, inertia "
      "xx {:+.3f}, yy {:+.3f}, zz {:+.3f} %\n",
      percent(points.volume, solid.volume), (p[0] - c[0]) / scene.grid.cell,
      (p[1] - c[1]) / scene.grid.cell, (p[2] - c[2]) / scene.grid.cell, percent(j[0], i[0]),
      percent(j[1], i[1]), percent(j[2], i[2]));
  fmt::print(
      "  thickness along the grid's axes: {:.3g} cells in all; a twentieth of the mass lies "
      "where it is below {:.3g} cells\n",
      body.fill_report().smallest_thickness_in_cells, body.thickness() / scene.grid.cell);
}

void print_body(const Simulation& sim, const Body& body, int index) {
  const Totals t = sim.totals(index);
  fmt::print("body {}: material {}, {:.0f} points, mass {:.6g} kg\n", body.name(),
             body.material().name, t.count, t.mass);
  if (const RigidBody* rigid = sim.rigid().find(index))
    fmt::print("  rigid, {}:{}\n", rigid->options().free ? "free" : "prescribed motion",
               describe_motion(sim.scene().frame, rigid->options()));
  print_shape(sim.scene(), body);
  fmt::print("  stages:");
  for (const NamedStage& s : body.stages()) fmt::print(" {};", s.name);
  if (!body.options().rigid())
    fmt::print("\n  pressure: {}", body.pressure_on_grid(sim.scene())
                                       ? "integrated on the grid (a fluid, or a soft solid)"
                                       : "integrated over the points");
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

/// Some body of this material can deform.
bool deforms(const Scene& scene, const MaterialOptions& material) {
  for (const BodyOptions& body : scene.bodies)
    if (&scene.materials[static_cast<std::size_t>(body.material)] == &material && !body.rigid())
      return true;
  return false;
}

/// Impact regime by velocity and stress (BUSH, after Zukas): what a scene of this speed needs.
void print_advice(const Scene& scene, double fastest, double closing) {
  for (const MaterialOptions& m : scene.materials) {
    if (!deforms(scene, m)) continue;
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
          "advice: {}: impact at {:.0f} m/s: plastic_work misses the heat of the shock "
          "(src/THEORY.md 8); "
          "heating: {{energy: {{c_v: ...}}}} sees it\n",
          m.name, closing);
  }
}

/// A results folder with the start as its only frame, for a look at the set-up.
void write_start(const Simulation& sim, const std::string& folder) {
  const Scene& scene = sim.scene();
  ResultsFolder results{folder, false};
  FolderLock lock;
  results.set_attributes({{"program", "krater " + version().program},
                          {"revision", version().revision},
                          {"title", scene.title},
                          {"frame", std::string{name(scene.frame)}},
                          {"cell", fmt::format("{:.17g} m", scene.grid.cell)}});
  lock.take(results.path());
  results.write_text("resolved.yaml", scene.resolved);
  results.write_frame(make_frame(sim, 0));
  Json summary;
  summary["title"] = Json::of(scene.title);
  summary["status"] = Json::of(std::string{"checked"});
  summary["frame"] = Json::of(std::string{name(scene.frame)});
  summary["cell"] = Json::of(scene.grid.cell);
  summary["points"] = Json::of(static_cast<std::int64_t>(sim.point_count()));
  results.write_summary(summary);
  results.flush();
}

/// Which bodies may touch, and how.
void print_contact(const Scene& scene) {
  const ContactOptions& contact = scene.contact;
  if (!contact.active) return;
  fmt::print("contact: normals by {}; friction", contact.normal == ContactNormal::volume_gradient
                                                     ? "volume gradient"
                                                     : "logistic regression");
  for (int a = 0; a < contact.fields; ++a)
    for (int b = a + 1; b < contact.fields; ++b)
      fmt::print(" {} - {}: {:g};", scene.bodies[static_cast<std::size_t>(a)].name,
                 scene.bodies[static_cast<std::size_t>(b)].name, contact.friction_of(a, b));
  fmt::print("\n");
}

}  // namespace

void print_check(const RunOptions& options) {
  set_threads(options.threads);
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
  print_contact(scene);
  const double steps =
      scene.time.end * (fastest + 1.35 * signal) / (scene.time.cfl * scene.grid.cell);
  const double work = steps * static_cast<double>(sim.point_count());
  fmt::print("estimate: {:.0f} steps, {:.0f} MB, {:.1f} s on one core\n", steps,
             1e-6 * sim.bytes_per_point() * static_cast<double>(sim.point_count()),
             work / (dimension(scene.frame) == 3 ? kRate3d : kRate2d));
  if (!options.output.empty()) write_start(sim, options.output);
  print_advice(scene, fastest, closing_speed(sim, fastest));
  for (const MaterialOptions& m : scene.materials)
    for (const std::string& key : m.unused)
      fmt::print("note: {}: its card holds {}, which this scene does not use ({}: card)\n", m.name,
                 key, key);
  for (const MaterialOptions& m : scene.materials)
    for (const std::string& doubt : examine(m)) fmt::print("doubt: {}: {}\n", m.name, doubt);
  for (const std::string& doubt : doubt_fields(scene)) fmt::print("doubt: {}\n", doubt);
}

}  // namespace krater
