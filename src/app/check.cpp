// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "krater/app/card_doctor.hpp"
#include "krater/app/check.hpp"
#include "krater/app/command_line.hpp"
#include "krater/app/effects.hpp"
#include "krater/app/field_doubts.hpp"
#include "krater/app/folder_lock.hpp"
#include "krater/app/forecast.hpp"
#include "krater/app/level_report.hpp"
#include "krater/app/run.hpp"
#include "krater/app/version.hpp"
#include "krater/core/parallel.hpp"
#include "krater/geometry/meshes/mesh.hpp"
#include "krater/geometry/seeds/column.hpp"
#include "krater/measure/gauges.hpp"
#include "krater/measure/measurements.hpp"
#include "krater/measure/outcomes.hpp"
#include "krater/measure/snapshot.hpp"
#include "krater/simulation/rigid_course.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

namespace {

/// More points are not made to be looked at: a coarser lattice stands for them.
constexpr double kMostMade = 1e6;

const char* unit_of(Frame frame) { return frame == Frame::plane_strain ? "m^3 (1 m of y)" : "m^3"; }

/// What is looked at: the scene, or where that has too many points the same scene with cells
/// `coarser` times as long.
struct Sample {
  Scene scene;
  int coarser = 1;
};

Sample sample_of(const Scene& scene, double points) {
  Sample out{scene, 1};
  const int dim = dimension(scene.frame);
  out.coarser = static_cast<int>(std::ceil(std::pow(points / kMostMade, 1.0 / dim)));
  if (out.coarser <= 1) return {scene, 1};
  GridOptions& grid = out.scene.grid;
  grid.cell *= out.coarser;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a)
    grid.max[a] =
        grid.min[a] + grid.cell * std::ceil((grid.max[a] - grid.min[a]) / grid.cell * (1 - 1e-12));
  // The times and the thickness are judged by the scene's own cell.
  out.scene.time.first_step = out.scene.time.min_step = 0;
  for (BodyOptions& body : out.scene.bodies) body.thin_allowed = true;
  return out;
}

void print_fill(const Scene& scene, const Body& body, const VolumeMoments& solid) {
  const VolumeMoments& points = body.seed_moments();
  const Triple c = solid.centroid(), p = points.centroid();
  const auto i = solid.inertia(), j = points.inertia();
  const auto percent = [](double a, double b) { return 100 * (a / b - 1); };
  fmt::print(
      "  points - solid: mass {:+.4f} %, centroid ({:+.2g}, {:+.2g}, {:+.2g}) cells, inertia "
      "xx {:+.3f}, yy {:+.3f}, zz {:+.3f} %\n",
      percent(points.volume, solid.volume), (p[0] - c[0]) / scene.grid.cell,
      (p[1] - c[1]) / scene.grid.cell, (p[2] - c[2]) / scene.grid.cell, percent(j[0], i[0]),
      percent(j[1], i[1]), percent(j[2], i[2]));
}

/// The body as drawn, in the domain, and what its points make of it.
void print_shape(const Scene& scene, const Body& body, int coarser) {
  bool exact = false;
  const VolumeMoments solid =
      moments_in(*body.options().solid, scene.frame, domain_box(scene), &exact);
  const double rho = body.material().density;
  const Triple c = solid.centroid();
  const auto i = solid.inertia();
  fmt::print(
      "  solid ({}): volume {:.6g} {}, mass {:.6g} kg, centroid ({:.5g}, {:.5g}, {:.5g}) m\n",
      exact ? "closed form" : "quadrature", solid.volume, unit_of(scene.frame), rho * solid.volume,
      c[0], c[1], c[2]);
  fmt::print(
      "    inertia about it: xx {:.5g}, yy {:.5g}, zz {:.5g}, yz {:.3g}, xz {:.3g}, xy {:.3g} "
      "kg m^2\n",
      rho * i[0], rho * i[1], rho * i[2], rho * i[3] + 0.0, rho * i[4] + 0.0, rho * i[5] + 0.0);
  if (coarser == 1) print_fill(scene, body, solid);
  fmt::print(
      "  thickness along the grid's axes: {:.3g} cells in all; a twentieth of the mass lies "
      "where it is below {:.3g} cells\n",
      coarser * body.fill_report().smallest_thickness_in_cells,
      coarser * body.thickness() / body.seed_cell());
}

/// Which element is worst, and which sets the step.
void print_elements(const Simulation& sim) {
  if (sim.mesh() == nullptr) return;
  const MeshHealth& mesh = sim.elements();
  const std::string place =
      mesh.worst_body < 0 || mesh.least_corner > 1 - 1e-9
          ? ""
          : fmt::format(" in element {} of {}", mesh.worst_element,
                        sim.bodies()[static_cast<std::size_t>(mesh.worst_body)]->name());
  fmt::print("elements: {}; least corner Jacobian {:.4g} of its element's mean{}\n", mesh.elements,
             mesh.least_corner, place);
  fmt::print("  time step {:.4g} s, {}\n", sim.stable_step(), sim.describe_limit());
}

/// How many neighbours particles have, and which sets the step.
void print_particles(const Simulation& sim) {
  if (sim.sph() == nullptr) return;
  const SphHealth health = sim.sph()->health();
  fmt::print(
      "particles: {}, {} images beyond planes of symmetry; {:.3g} neighbours in lists; {} "
      "with gradients that are not corrected in full\n",
      health.particles, health.images, health.neighbours, health.flat);
  fmt::print("  time step {:.4g} s, {}\n", sim.stable_step(), sim.describe_limit());
}

const char* kernel_name(SphKernel kernel) {
  switch (kernel) {
    case SphKernel::wendland_c2:
      return "Wendland C2";
    case SphKernel::quadratic:
      return "quadratic";
    case SphKernel::cubic_spline:
      break;
  }
  return "cubic spline";
}

void print_sph(const SphOptions& sph) {
  constexpr std::array references{"current", "initial", "adaptive"};
  fmt::print("  sph: spacing {:.4g} m, smoothing length {:.4g} m, {}, {} gradients, reference {}\n",
             sph.spacing, sph.length(), kernel_name(sph.kernel),
             sph.correction == SphCorrection::linear ? "corrected" : "uncorrected",
             references[static_cast<std::size_t>(sph.reference)]);
}

void print_block(const Scene& scene, const BodyOptions& body) {
  const Box box =
      intersection(body.solid->extent(scene.frame), domain_box(scene), dimension(scene.frame));
  const auto counts = elements_along(scene.frame, box.min, box.max, body.mesh->element);
  for (int a = 0; a < dimension(scene.frame); ++a)
    fmt::print("{}{} elements of {:.4g} m along {}", a > 0 ? ", " : "",
               counts[static_cast<std::size_t>(a)],
               box.length(a) / counts[static_cast<std::size_t>(a)], axis_name(scene.frame, a));
}

/// What is not a block: its elements, and what their flat faces leave of the solid.
void print_own_mesh(const Scene& scene, const BodyOptions& body, double volume) {
  const Mesh& mesh = *body.mesh->mesh;
  const MeshQuality quality = mesh_quality(mesh);
  fmt::print("{} elements, edges {:.4g} to {:.4g} m, least scaled Jacobian {:.3f}",
             mesh.element_count(), quality.shortest, quality.longest, quality.least_jacobian);
  if (body.solid->elements() != nullptr) return;
  const double whole = moments_in(*body.solid, scene.frame, domain_box(scene)).volume;
  fmt::print(", volume and mass {:+.3g} % of the shape's (nodes on its surface, faces flat)",
             100 * (volume / whole - 1));
}

// Edge of an element up to which its points have its angular momentum [cells] (conversion.hpp).
constexpr double kTurns = 1.15;

void print_mesh(const Scene& scene, const BodyOptions& body, double volume) {
  fmt::print("  lagrangian mesh: ");
  if (body.mesh->mesh)
    print_own_mesh(scene, body, volume);
  else
    print_block(scene, body);
  constexpr std::array kinds{"assumed strain", "stiffness", "viscous"};
  constexpr std::array references{"", ", on the initial reference", ", on adaptive references"};
  fmt::print("; hourglass: {}{}\n", kinds[static_cast<std::size_t>(body.mesh->hourglass.kind)],
             references[static_cast<std::size_t>(body.mesh->reference)]);
  if (!body.mesh->erosion.any()) return;
  fmt::print("  elements that fail as `when` says {}\n",
             body.mesh->converts ? "become points" : "are eroded");
  const double longest =
      body.mesh->mesh ? mesh_quality(*body.mesh->mesh).longest : body.mesh->element;
  if (body.mesh->converts && longest > kTurns * scene.grid.cell)
    fmt::print(
        "  beyond {} cells an element that becomes points loses angular momentum: use a smaller "
        "element or a larger grid.cell\n",
        kTurns);
}

void print_body(const Simulation& sim, const Scene& scene, int index, int coarser) {
  const Body& body = *sim.bodies()[static_cast<std::size_t>(index)];
  const Totals t = sim.totals(index);
  const double points = coarser == 1 ? t.count : body.options().point_estimate;
  fmt::print("body {}: material {}, {} points, mass {:.6g} kg\n", body.name(), body.material().name,
             coarser == 1 ? fmt::format("{:.0f}", points) : "about " + count_text(points), t.mass);
  if (const RigidBody* rigid = sim.rigid().find(index))
    fmt::print("  rigid, {}:{}\n", rigid->options().free ? "free" : "prescribed motion",
               describe_motion(scene.frame, rigid->options()));
  if (body.options().mesh)
    print_mesh(scene, body.options(), t.mass / body.material().density);
  else
    print_shape(scene, body, coarser);
  if (body.options().sph) print_sph(*body.options().sph);
  fmt::print("  stages:");
  for (const NamedStage& s : body.stages()) fmt::print(" {};", s.name);
  if (!body.options().rigid() && body.options().material_points())
    fmt::print("\n  pressure: {}", body.pressure_on_grid(sim.scene())
                                       ? "integrated on the grid (a fluid, or a soft solid)"
                                       : "integrated over the points");
  fmt::print("\n  columns ({} bytes per point):", body.layout().stride());
  for (const Column& column : body.layout().columns())
    fmt::print(" {}{}", column.field->name,
               column.components > 1 ? fmt::format("[{}]", column.components) : "");
  fmt::print("\n");
}

/// Effects, what they cost and do, and what the speed of the impact says of them.
void print_effects(const Scene& scene, const Simulation& sim) {
  const EffectReport report = report_effects(scene, EffectCosts{scene, sim.isa_level()}, "");
  for (const std::string& line : effect_table(scene, report)) fmt::print("{}\n", line);
  fmt::print("  (ns are told by krater run, influence by krater study of kind ablation)\n");
  for (const std::string& sentence : report.sentences) fmt::print("advice: {}\n", sentence);
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

void print_estimate(const Forecast& cost) {
  fmt::print(
      "estimate: {:.0f} steps{}, {} of results, {} of memory, {} on one core ({} to set up, {} to "
      "write)\n",
      cost.steps,
      cost.cut_steps > 0.05 * cost.steps
          ? fmt::format(" ({:.0f} of them because frames cut them)", cost.cut_steps)
          : "",
      bytes_text(cost.results), bytes_text(cost.memory), duration_text(cost.seconds()),
      duration_text(cost.setup), duration_text(cost.writing));
}

void print_cards(const Scene& scene) {
  for (const MaterialOptions& m : scene.materials)
    if (!m.card.empty()) fmt::print("material {}: card {}\n", m.name, m.card);
  for (const std::string& note : card_notes(scene)) fmt::print("note: {}\n", note);
}

void print_text(const Checked& of, const std::string& file) {
  const auto& [scene, sim, cost, coarser] = of;
  fmt::print("{}\nframe {}, cell {:g} m\n", scene.title.empty() ? file : scene.title,
             name(scene.frame), scene.grid.cell);
  if (coarser > 1)
    fmt::print(
        "note: {} points are not made to be looked at: bodies are filled with cells {} times as "
        "long\n",
        count_text(cost.points), coarser);
  for (std::size_t b = 0; b < sim.bodies().size(); ++b)
    print_body(sim, scene, static_cast<int>(b), coarser);
  for (const std::string& line : report_levels(sim, coarser)) fmt::print("{}\n", line);
  print_elements(sim);
  print_particles(sim);
  print_contact(scene);
  print_estimate(cost);
  print_effects(scene, sim);
  print_cards(scene);
  for (const std::string& doubt : doubts_of(scene)) fmt::print("doubt: {}\n", doubt);
  for (const std::string& doubt : doubt_levels(sim)) fmt::print("doubt: {}\n", doubt);
  for (const std::string& doubt : doubt_course(sim)) fmt::print("doubt: {}\n", doubt);
}

}  // namespace

std::vector<std::string> card_notes(const Scene& scene) {
  std::vector<std::string> notes;
  for (const MaterialOptions& m : scene.materials) {
    for (const std::string& key : m.unused)
      notes.push_back(fmt::format("{}: its card holds {}, which this scene does not use ({}: card)",
                                  m.name, key, key));
    if (!m.unsourced.empty())
      notes.push_back(
          fmt::format("{}: its card has no source for {}", m.name, fmt::join(m.unsourced, ", ")));
  }
  return notes;
}

std::vector<std::string> doubts_of(const Scene& scene) {
  std::vector<std::string> doubts;
  for (const MaterialOptions& m : scene.materials)
    for (const std::string& doubt : examine(m))
      doubts.push_back(fmt::format("{}: {}", m.name, doubt));
  for (const auto& some : {doubt_fields(scene), doubt_method(scene), doubt_scene(scene)})
    doubts.insert(doubts.end(), some.begin(), some.end());
  return doubts;
}

void print_check(const RunOptions& options) {
  set_threads(options.threads);
  const Scene scene = read_scene(options.scene, options.overrides);
  if (!options.json)
    for (const std::string& note : scene.notes) fmt::print("note: {}\n", note);
  const Forecast cost = forecast(scene);
  require_feasible(scene, cost);
  const Sample sample = sample_of(scene, options.output.empty() ? cost.points : 0);
  const Simulation sim{sample.scene};
  // What a run refuses before its first step.
  Measurements measurements{sim};
  measurements.check(sim);
  std::vector<Quantity> columns = history_row(sim);
  for (const Quantity& title : measurements.titles(scene)) columns.push_back(title);
  Outcomes{sim, columns};
  Gauges{sim, measurements};
  if (sample.coarser > 1) {
    require_steps(scene.time, sim.stable_step() / sample.coarser);
    for (std::size_t b = 0; b < sim.bodies().size(); ++b)
      if (!scene.bodies[b].thin_allowed) sim.bodies()[b]->require_thickness(scene.grid.cell);
  }
  if (!options.output.empty()) write_start(sim, options.output);
  const Checked checked{scene, sim, cost, sample.coarser};
  if (options.json)
    fmt::print("{}", to_text(check_json(checked)));
  else
    print_text(checked, options.scene);
}

}  // namespace krater
