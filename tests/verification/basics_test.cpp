// SPDX-License-Identifier: GPL-3.0-or-later
// What every scheme must do exactly, in all frames: forces adjoint to velocity gradients, motions
// that change nothing, balances, and the same bits whatever the machine.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "krater/contact/boundary.hpp"
#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/frames.hpp"
#include "verification/run_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

constexpr double kDensity = 1000, kBulk = 1e9, kShear = 5e8;
const double kWaveSpeed = std::sqrt((kBulk + 4.0 / 3.0 * kShear) / kDensity);

const std::string kFrames[] = {"axisymmetric", "plane_strain", "3d"};
const std::string kShapes[] = {"quadratic_bspline", "gimp", "linear"};
const std::string kTransfers[] = {"tflip", "flip", "apic", "xpic"};
const std::string kUpdates[] = {"usl", "musl", "usf"};

bool is_3d(const std::string& frame) { return frame == "3d"; }

/// An elastic block of cells of 1 m in [0, size] of a domain [0, domain]; in 3d y is as x. All
/// sides get `side` (the axis where the frame has one).
std::string block_scene(const std::string& frame, double size, double domain,
                        const std::string& side, double low = 0) {
  std::ostringstream yaml;
  yaml.precision(17);
  const auto corner = [&](double x) {
    std::ostringstream text;
    text << "[" << x << ", " << x << (is_3d(frame) ? ", " + std::to_string(x) : "") << "]";
    return text.str();
  };
  const bool axis = frame == "axisymmetric";
  yaml << "frame: " << frame << "\ngrid:\n  cell: 1\n  box: {min: " << corner(0)
       << ", max: " << corner(domain) << "}\n  boundary: {"
       << (axis ? "r_min: axis, r_max: " : "x_min: " + side + ", x_max: ") << side
       << (is_3d(frame) ? ", y_min: " + side + ", y_max: " + side : "") << ", z_min: " << side
       << ", z_max: " << side << "}\ntime: {end: 1}\nmaterials:\n  m:\n    density: " << kDensity
       << "\n    bulk_modulus: " << kBulk << "\n    shear_modulus: " << kShear
       << "\n    eos: linear\n    strength: elastic\n    viscosity: {q_lin: 0.3, q_quad: 2.0}\n"
       << "bodies:\n  block:\n    material: m\n    shape: {";
  if (axis)
    yaml << "cylinder: {radius: " << size << ", height: " << size << ", base: [0, 0, " << low
         << "]}}\n";
  else
    yaml << "box: {min: " << corner(low) << ", max: " << corner(low + size) << "}}\n";
  return yaml.str();
}

Overrides method(const std::string& shape, const std::string& transfer, const std::string& update) {
  return {"method.shape=" + shape, "method.transfer=" + transfer, "method.update=" + update};
}
bool refused(const std::string& shape, const std::string& transfer, const std::string& update) {
  if (shape == "linear" && (update == "usl" || transfer == "tflip" || transfer == "apic"))
    return true;
  if (transfer == "xpic" && update != "usl") return true;
  return shape == "gimp" && transfer == "flip" && update == "usl";
}

/// The default scheme of a shape.
Overrides scheme_of(const std::string& shape) {
  return shape == "linear" ? method(shape, "flip", "musl") : method(shape, "tflip", "usl");
}

/// Calls `check(frame, overrides, name)` for every scheme in every frame.
template <class Check>
void for_each_scheme(const Check& check) {
  for (const std::string& frame : kFrames)
    for (const std::string& shape : kShapes)
      for (const std::string& transfer : kTransfers)
        for (const std::string& update : kUpdates)
          if (!refused(shape, transfer, update))
            check(frame, method(shape, transfer, update),
                  frame + " " + shape + " " + transfer + " " + update);
}

struct Random {
  std::mt19937_64 engine{7};
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(engine);
  }
  std::vector<double> many(std::size_t n, double low, double high) {
    std::vector<double> x(n);
    for (double& value : x) value = (*this)(low, high);
    return x;
  }
};

void randomize(Run& run, const FieldInfo& field, double low, double high, Random& random) {
  const Column* c = run.sim->bodies()[0]->layout().find(field.name);
  REQUIRE(c != nullptr);
  for (int k = 0; k < c->components; ++k)
    set_column(run, field, k, random.many(run.sim->point_count(), low, high));
}

/// Fixed reference: F near the identity, another one for every point.
void distort(Run& run, Random& random) {
  const int dim = run.sim->geometry().dimension;
  for (int i = 0; i < dim; ++i)
    for (int a = 0; a < dim; ++a) {
      std::vector<double> F = random.many(run.sim->point_count(), -0.25, 0.25);
      for (double& x : F) x += i == a ? 1 : 0;
      set_column(run, field::ConfigurationMap::info, dim * i + a, F);
    }
}

double largest(const std::vector<double>& x) {
  double worst = 0;
  for (const double value : x) worst = std::max(worst, std::abs(value));
  return worst;
}

/// The kernels of one step taken apart: scatter, then nodal velocities of the caller's choice, then
/// the gather.
class Rig {
 public:
  Rig(Run& run, KernelFrame frame, KernelShape shape, bool averaging, bool stages)
      : run_{run},
        dim_{run.sim->geometry().dimension},
        data_{run.sim->bodies()[0]->kernel_data()},
        boundary_{run.sim->geometry(), run.scene->grid.boundary},
        kernels_{
            kernel_factory(best_isa_level())
                .make({frame, shape, false, run.scene->method.reference != Reference::current})} {
    if (!stages) data_.stage_count = 0;
    settings_.geometry = &run.sim->geometry();
    settings_.dt = 1;
    settings_.average_cells = averaging;
    zeros_.reserve(9 * kLanes), halo_.reserve(216 * kNodeDoubles), cells_.reserve(kCellDoubles);
    boundary_.relink(grid());
    local_.resize(grid().patches().size());
  }
  int dim() const { return dim_; }
  double h() const { return run_.sim->geometry().h; }
  void set_dt(double dt) { settings_.dt = dt; }

  /// Node sums [m, p, f, V] with symmetry folded in.
  void scatter() {
    for (std::size_t p = 0; p < grid().patches().size(); ++p)
      kernels_->scatter(grid().patches()[p], data_, settings_, scratch(p));
    for (NodeBlock& block : grid().node_blocks()) kernels_->sum_tiles(grid(), block);
    boundary_.fold();
  }
  /// Calls visit(record, position of the node in cells from the lower corner).
  template <class Visit>
  void for_each_node(const Visit& visit) {
    const int edge = block_edge(dim_);
    for (NodeBlock& block : grid().node_blocks())
      for (int n = 0; n < kBlockNodes; ++n) {
        std::array<int, 3> at{};
        for (int a = dim_ - 1, rest = n; a >= 0; --a, rest /= edge)
          at[static_cast<unsigned>(a)] =
              block.key.i[static_cast<unsigned>(a)] * edge + rest % edge - 1;
        visit(block.nodes + kNodeDoubles * n, at);
      }
  }
  /// sum f.v over nodes where v = velocity(node position, axis); the nodes then hold v.
  template <class Velocity>
  double impose(const Velocity& velocity) {
    double power = 0;
    for_each_node([&](double* node, const std::array<int, 3>& at) {
      std::array<double, 3> v{};
      for (int a = 0; a < dim_; ++a) v[static_cast<unsigned>(a)] = velocity(at, a);
      for (int a = 0; a < dim_; ++a)
        for (int side = 0; side < 2; ++side) {
          const int plane = side == 0 ? 0 : run_.sim->geometry().cells[static_cast<unsigned>(a)];
          const BoundaryKind kind =
              boundary_.conditions()[static_cast<unsigned>(a)][static_cast<unsigned>(side)].kind;
          if (at[static_cast<unsigned>(a)] != plane) continue;
          if (kind == BoundaryKind::symmetry) v[static_cast<unsigned>(a)] = 0;
          if (kind == BoundaryKind::sticky) v = {};
        }
      const double m = node[0], V = node[7];
      for (int a = 0; a < dim_; ++a) power += node[4 + a] * v[static_cast<unsigned>(a)];
      for (int a = 0; a < 3; ++a) node[a] = v[static_cast<unsigned>(a)], node[4 + a] = 0;
      node[3] = m, node[7] = V;
    });
    boundary_.mirror();
    return power;
  }
  void gather() {
    for (std::size_t p = 0; p < grid().patches().size(); ++p)
      kernels_->gather(grid().patches()[p], grid(), data_, settings_, scratch(p), GatherPart::all);
  }
  /// dt L of a point after the gather, tensor axes.
  double step_gradient(int patch, int point, int i, int a) const {
    return local(patch, point, data_.columns.local_gradient, 3 * i + a);
  }
  double extra_dilatation(int patch, int point) const {
    return local(patch, point, data_.columns.local_dilatation, 0);
  }

 private:
  BlockGrid& grid() { return run_.sim->grid(); }
  double local(int patch, int point, int offset, int k) const {
    return local_[static_cast<std::size_t>(patch)]
        .data()[point / kLanes * data_.columns.local_stride + offset + kLanes * k + point % kLanes];
  }
  SweepScratch scratch(std::size_t p) {
    const auto groups = static_cast<std::size_t>(grid().patches()[p].points.groups());
    local_[p].reserve(groups * static_cast<std::size_t>(data_.columns.local_stride));
    pressures_.reserve(groups * kLanes);
    leavers_.resize(std::max(leavers_.size(), groups));
    return {halo_.data(),      nullptr,         local_[p].data(), cells_.data(),
            pressures_.data(), leavers_.data(), zeros_.data()};  // no fluid
  }

  Run& run_;
  int dim_;
  BodyKernelData data_;
  BoundarySet boundary_;
  std::unique_ptr<Kernels> kernels_;
  SweepSettings settings_;
  AlignedBuffer zeros_, halo_, cells_, pressures_;
  std::vector<AlignedBuffer> local_;
  std::vector<unsigned char> leavers_;
};

KernelFrame kernel_frame(const std::string& frame) {
  if (frame == "axisymmetric") return KernelFrame::axisymmetric;
  return frame == "3d" ? KernelFrame::space : KernelFrame::plane;
}
constexpr KernelShape kKernelShapes[] = {KernelShape::quadratic_bspline, KernelShape::gimp,
                                         KernelShape::linear};

/// - sum V sigma : L over the points after a gather, with the averaged dilatation where it is on;
/// `scale`: the sum of the magnitudes.
double point_power(const Run& run, const Rig& rig, double& scale) {
  const Body& body = *run.sim->bodies()[0];
  double power = 0;
  scale = 0;
  for (const auto& [patch, point] : run.sim->points_by_id(0)) {
    const auto at = [&, p = patch, i = point](const FieldInfo& f, int k = 0) {
      return run.sim->value(p, i, body.slot(f, k));
    };
    const double V = at(field::Mass::info) / at(field::Density::info);
    const double P = at(field::Pressure::info) + at(field::ViscousPressure::info);
    double trace = rig.extra_dilatation(patch, point), sum = 0;
    for (int i = 0; i < 3; ++i) {
      trace += rig.step_gradient(patch, point, i, i);
      for (int a = 0; a < 3; ++a)
        sum +=
            at(field::DeviatoricStress::info, voigt(i, a)) * rig.step_gradient(patch, point, i, a);
    }
    power -= V * (sum - P * trace);
    scale += V * (std::abs(sum) + std::abs(P * trace));
  }
  return power;
}

/// A rotation about the axis (1, 2, 3) in 3d, about y in two dimensions, over tensor axes.
std::array<std::array<double, 3>, 3> rotation(int dim, double angle) {
  const double n = std::sqrt(14.0);
  const std::array<double, 3> u =
      dim == 3 ? std::array<double, 3>{1 / n, 2 / n, 3 / n} : std::array<double, 3>{0, 1, 0};
  const double c = std::cos(angle), s = std::sin(angle);
  std::array<std::array<double, 3>, 3> R{};
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned j = 0; j < 3; ++j) R[i][j] = u[i] * u[j] * (1 - c) + (i == j ? c : 0);
  R[0][1] -= u[2] * s, R[1][0] += u[2] * s;
  R[0][2] += u[1] * s, R[2][0] -= u[1] * s;
  R[1][2] -= u[0] * s, R[2][1] += u[0] * s;
  return R;
}

}  // namespace

TEST_SUITE("verification") {
  TEST_CASE("power of the nodal forces equals - sum V sigma : L, whatever state and velocities") {
    Random random;
    double worst = 0;
    for (const std::string& frame : kFrames)
      for (const std::string side : {"symmetry", "open", "sticky"})
        for (const int variant : {0, 1, 2, 3})
          for (std::size_t shape = 0; shape < 3; ++shape) {
            const bool averaging = variant % 2 != 0, fixed = variant / 2 != 0;
            CAPTURE(frame);
            CAPTURE(side);
            CAPTURE(averaging);
            CAPTURE(fixed);
            CAPTURE(kShapes[shape]);
            const double size = is_3d(frame) ? 6 : 11;
            Overrides options =
                fixed ? method(kShapes[shape], "tflip", "usl") : scheme_of(kShapes[shape]);
            if (fixed) options.push_back("method.reference=initial");
            options.push_back("method.jitter=0.4");
            Run run = start_text(block_scene(frame, size, size, side), options);
            randomize(run, field::DeviatoricStress::info, -1, 1, random);
            randomize(run, field::Pressure::info, -1, 1, random);
            randomize(run, field::ViscousPressure::info, 0, 1, random);
            randomize(run, field::ShockIndicator::info, 0, 0.003, random);
            randomize(run, field::Density::info, 500, 1500, random);
            if (fixed) distort(run, random);
            Rig rig{run, kernel_frame(frame), kKernelShapes[shape], averaging, false};
            rig.scatter();
            const double on_nodes =
                rig.impose([&](const std::array<int, 3>&, int) { return random(-1, 1); });
            rig.gather();
            double scale = 0;
            const double on_points = point_power(run, rig, scale);
            REQUIRE(scale > 0);
            CHECK(std::abs(on_nodes) > 1e-6 * scale);
            CHECK(std::abs(on_nodes - on_points) < 1e-13 * scale);
            worst = std::max(worst, std::abs(on_nodes - on_points) / scale);
          }
    MESSAGE("largest |f.v + sum V sigma:L| / sum |V sigma:L| = " << worst);
  }

  TEST_CASE("a linear velocity field about the axis is seen exactly by every point") {
    const double a = 0.3, b = -0.2;
    for (std::size_t shape = 0; shape < 3; ++shape) {
      CAPTURE(kShapes[shape]);
      Overrides options = scheme_of(kShapes[shape]);
      options.push_back("method.jitter=0.4");
      Run run = start_text(block_scene("axisymmetric", 11, 12, "open"), options);
      Rig rig{run, KernelFrame::axisymmetric, kKernelShapes[shape], true, false};
      rig.scatter();
      rig.impose([&](const std::array<int, 3>& at, int axis) {
        return axis == 0 ? a * at[0] : b * at[1];
      });
      rig.gather();
      double worst = 0;
      for (const auto& [patch, point] : run.sim->points_by_id(0))
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k) {
            const double exact = i != k ? 0 : i == 2 ? b : a;
            worst = std::max(worst, std::abs(rig.step_gradient(patch, point, i, k) - exact));
          }
      CHECK(worst < 2e-14);
    }
  }

  TEST_CASE("a whole step of a uniform radial field: density and L exact to the axis") {
    const double a = 30, b = -20;
    for (const std::string transfer : {"tflip", "apic"})
      for (const std::string update : {"usl", "musl", "usf"})
        for (const std::string shape : {"quadratic_bspline", "gimp"}) {
          CAPTURE(transfer);
          CAPTURE(update);
          CAPTURE(shape);
          Run run = start_text(block_scene("axisymmetric", 8, 10, "open"),
                               method(shape, transfer, update));
          const auto r = column(run, field::Position::info, 0),
                     z = column(run, field::Position::info, 1);
          std::vector<double> vr, vz;
          for (std::size_t i = 0; i < r.size(); ++i) vr.push_back(a * r[i]), vz.push_back(b * z[i]);
          set_column(run, field::Velocity::info, 0, vr);
          set_column(run, field::Velocity::info, 1, vz);
          set_column(run, field::AffineVelocity::info, 0, std::vector<double>(r.size(), a));
          set_column(run, field::AffineVelocity::info, 3, std::vector<double>(r.size(), b));
          run_steps(run, 1);
          const double dt = run.sim->dt();
          const auto r1 = column(run, field::Position::info, 0);
          if (update == "usf") run_steps(run, 1);  // it strains the motion of the step before
          const double density = kDensity / ((1 + a * dt) * (1 + a * dt) * (1 + b * dt));
          double worst = 0, worst_L = 0;
          const auto rho = column(run, field::Density::info),
                     L0 = column(run, field::AffineVelocity::info, 0),
                     L1 = column(run, field::AffineVelocity::info, 1),
                     L3 = column(run, field::AffineVelocity::info, 3);
          for (std::size_t i = 0; i < r.size(); ++i) {
            worst = std::max(worst, std::abs(rho[i] / density - 1));
            worst = std::max(worst, std::abs(r1[i] / (r[i] * (1 + a * dt)) - 1));
            if (update == "usf") continue;  // its L is seen after the forces of the new stress
            worst_L = std::max(
                {worst_L, std::abs(L0[i] / a - 1), std::abs(L1[i] / a), std::abs(L3[i] / b - 1)});
          }
          // usf: L was that of the start of the motion.
          CHECK(worst < (update == "usf" ? a * dt * a * dt : 1e-13));
          CHECK(worst_L < 1e-11);
        }
  }

  TEST_CASE("a block that only moves does not change: every scheme in every frame") {
    double worst = 0;
    std::string worst_name;
    for_each_scheme([&](const std::string& frame, const Overrides& options,
                        const std::string& name) {
      CAPTURE(name);
      const bool axis = frame == "axisymmetric";
      Run run =
          start_text(block_scene(frame, is_3d(frame) ? 5 : 10, 40, "open", axis ? 2 : 1), options);
      const std::array<double, 3> v = axis           ? std::array<double, 3>{0, 600, 0}
                                      : is_3d(frame) ? std::array<double, 3>{423, 317, 600}
                                                     : std::array<double, 3>{423, 600, 0};
      for (int a = 0; a < run.sim->geometry().dimension; ++a)
        set_column(run, field::Velocity::info, a,
                   std::vector<double>(run.sim->point_count(), v[static_cast<unsigned>(a)]));
      const auto points = run.sim->point_count();
      run_steps(run, 60);
      CHECK(run.sim->time() * 600 > 4);  // at least a block of cells
      CHECK(run.sim->point_count() == points);
      double change = 0;
      for (int a = 0; a < run.sim->geometry().dimension; ++a)
        for (const double x : column(run, field::Velocity::info, a))
          change = std::max(change, std::abs(x - v[static_cast<unsigned>(a)]) / 600);
      for (const double x : column(run, field::Density::info))
        change = std::max(change, std::abs(x / kDensity - 1));
      change = std::max(change, largest(column(run, field::Pressure::info)) / kBulk);
      for (int k = 0; k < 6; ++k)
        change = std::max(change, largest(column(run, field::DeviatoricStress::info, k)) / kShear);
      CHECK(change < 1e-12);
      if (!(change <= worst)) worst = change, worst_name = name;
    });
    MESSAGE("largest change " << worst << " (" << worst_name << ")");
  }

  TEST_CASE("a body at rest stays exactly at rest") {
    for (const std::string& frame : kFrames) {
      Run run = start_text(block_scene(frame, is_3d(frame) ? 4 : 8, 12, "open"));
      const auto before = column(run, field::Position::info, 0);
      run_steps(run, 20);
      CHECK(column(run, field::Position::info, 0) == before);
      CHECK(run.sim->totals().kinetic == 0);
      CHECK(run.sim->totals().internal == 0);
    }
  }

  // f_i = - sum 2 pi A_p p (r S' + S) is the midpoint rule of an integral that vanishes: exact for
  // hats. For B-splines it leaves - 3 (s^2/24) [S'] at the ends of the sum, which at the axis is
  // h/32 of the pressure on the first node: a rod at rest settles with 3 % less pressure in the
  // first column of points.
  TEST_CASE("uniform pressure in a closed box is in balance, at the axis too") {
    for (const std::string& frame : kFrames)
      for (const std::string& shape : kShapes) {
        CAPTURE(frame);
        CAPTURE(shape);
        const double size = is_3d(frame) ? 6 : 11;
        Overrides options = scheme_of(shape);
        options.push_back("method.stagger=false");
        Run run = start_text(block_scene(frame, size, size, "symmetry"), options);
        const std::size_t n = run.sim->point_count();
        set_column(run, field::Density::info, 0, std::vector<double>(n, 1.01 * kDensity));
        set_column(run, field::Pressure::info, 0, std::vector<double>(n, 0.01 * kBulk));
        // The energy that this pressure has stored: what moves must have come from somewhere.
        set_column(run, field::InternalEnergy::info, 0,
                   std::vector<double>(n, 0.5e-4 * kBulk / kDensity));
        run_steps(run, 200);
        double speed = 0, pressure = 0;
        for (int a = 0; a < run.sim->geometry().dimension; ++a)
          speed = std::max(speed, largest(column(run, field::Velocity::info, a)));
        for (const double p : column(run, field::Pressure::info))
          pressure = std::max(pressure, std::abs(p / (0.01 * kBulk) - 1));
        const bool exact = frame != "axisymmetric" || shape != "quadratic_bspline";
        if (!exact)
          MESSAGE(frame << " " << shape << ": speed / c " << speed / kWaveSpeed
                        << ", pressure off by " << 100 * pressure << " %");
        CHECK(speed < (exact ? 1e-12 : 1e-4) * kWaveSpeed);
        CHECK(pressure < (exact ? 1e-11 : 0.06));
      }
  }

  TEST_CASE("mass is exact") {
    for (const std::string& frame : kFrames) {
      CAPTURE(frame);
      const Run run = start_text(block_scene(frame, 7.3, 12, "open", 0.7));
      const double volume = frame == "axisymmetric" ? std::numbers::pi * 7.3 * 7.3 * 7.3
                            : is_3d(frame)          ? 7.3 * 7.3 * 7.3
                                                    : 7.3 * 7.3;
      CHECK(run.sim->totals().mass == doctest::Approx(kDensity * volume).epsilon(1e-13));
    }
  }

  TEST_CASE("points that leave are removed, their mass, momentum and energy accounted") {
    for (const std::string& frame : kFrames) {
      CAPTURE(frame);
      Random random;
      Run run = start_text(block_scene(frame, 5, 8, "open", 1.5));
      randomize(run, field::Velocity::info, -100, 100, random);
      const int last = run.sim->geometry().dimension - 1;
      auto v = column(run, field::Velocity::info, last);
      for (double& x : v) x += 500;
      set_column(run, field::Velocity::info, last, v);
      const Totals start = run.sim->totals();
      run_steps(run, 60);
      const Totals now = run.sim->totals();
      const Audit& audit = run.sim->audit();
      MESSAGE(frame << ": " << audit.removed_points << " of " << start.count << " points left");
      CHECK(audit.removed_points > 0.2 * start.count);
      CHECK(now.count + audit.removed_points == start.count);
      CHECK(now.mass + audit.removed_mass == doctest::Approx(start.mass).epsilon(1e-14));
      const auto z = static_cast<std::size_t>(last);
      CHECK(now.momentum[z] + audit.removed_momentum[z] ==
            doctest::Approx(start.momentum[z]).epsilon(1e-13));
      CHECK(std::abs(energy_residual(run)) < 1e-12 * start.kinetic);
    }
  }

  TEST_CASE("rigid rotation in one step turns the stress with it") {
    Random random;
    for (const std::string frame : {"plane_strain", "3d"})
      for (const double angle : {0.1, 1.0, 3.0}) {
        CAPTURE(frame);
        CAPTURE(angle);
        Run run = start_text(block_scene(frame, is_3d(frame) ? 5 : 9, 12, "open", 2),
                             {"method.jitter=0.4"});
        randomize(run, field::DeviatoricStress::info, -0.01 * kShear, 0.01 * kShear, random);
        std::array<std::vector<double>, 6> s;
        for (int k = 0; k < 6; ++k)
          s[static_cast<unsigned>(k)] = column(run, field::DeviatoricStress::info, k);
        for (std::size_t p = 0; p < s[0].size(); ++p) {
          const double mean = (s[0][p] + s[1][p] + s[2][p]) / 3;
          for (unsigned k = 0; k < 3; ++k) s[k][p] -= mean;
          if (!is_3d(frame)) s[3][p] = s[5][p] = 0;  // out of plane shear
        }
        for (int k = 0; k < 6; ++k)
          set_column(run, field::DeviatoricStress::info, k, s[static_cast<unsigned>(k)]);
        Rig rig{run, kernel_frame(frame), KernelShape::quadratic_bspline, true, true};
        const auto R = rotation(rig.dim(), angle);
        rig.scatter();
        rig.impose([&](const std::array<int, 3>& at, int axis) {
          double v = 0;
          const auto tensor = [&](int a) {
            return static_cast<unsigned>(rig.dim() == 2 ? 2 * a : a);
          };
          for (int b = 0; b < rig.dim(); ++b)
            v += (R[tensor(axis)][tensor(b)] - (axis == b ? 1 : 0)) * at[static_cast<unsigned>(b)];
          return v;
        });
        rig.gather();
        double worst = 0;
        const auto full = [&](std::size_t p, unsigned i, unsigned j) {
          return s[static_cast<unsigned>(voigt(static_cast<int>(i), static_cast<int>(j)))][p];
        };
        for (unsigned i = 0; i < 3; ++i)
          for (unsigned j = i; j < 3; ++j) {
            const auto now = column(run, field::DeviatoricStress::info,
                                    voigt(static_cast<int>(i), static_cast<int>(j)));
            for (std::size_t p = 0; p < now.size(); ++p) {
              double turned = 0;
              for (unsigned k = 0; k < 3; ++k)
                for (unsigned l = 0; l < 3; ++l) turned += R[i][k] * full(p, k, l) * R[j][l];
              worst = std::max(worst, std::abs(now[p] - turned));
            }
          }
        MESSAGE(frame << " angle " << angle << ": stress off by " << worst / kShear << " G");
        CHECK(worst < 1e-12 * kShear);
        for (const double rho : column(run, field::Density::info))
          CHECK(std::abs(rho / kDensity - 1) < 1e-13);
        CHECK(largest(column(run, field::Pressure::info)) < 1e-12 * kBulk);
      }
  }

  TEST_CASE("a step does not know how fast the frame of reference moves") {
    for_each_scheme(
        [&](const std::string& frame, const Overrides& options, const std::string& name) {
          CAPTURE(name);
          Overrides all = options;
          all.push_back("time.first_step=1e-4");
          const std::string yaml = block_scene(frame, is_3d(frame) ? 4 : 7, 12, "open", 2);
          Run rest = start_text(yaml, all), moving = start_text(yaml, all);
          Random random, same;
          randomize(rest, field::Velocity::info, -10, 10, random);
          randomize(moving, field::Velocity::info, -10, 10, same);
          const int last = rest.sim->geometry().dimension - 1;
          const double shift = 300;
          auto v = column(moving, field::Velocity::info, last);
          for (double& x : v) x += shift;
          set_column(moving, field::Velocity::info, last, v);
          run_steps(rest, 1), run_steps(moving, 1);
          REQUIRE(rest.sim->dt() == moving.sim->dt());
          const auto compare = [&](const FieldInfo& f, int k, double offset, double scale) {
            const auto x = column(rest, f, k), y = column(moving, f, k);
            double worst = 0;
            for (std::size_t i = 0; i < x.size(); ++i)
              worst = std::max(worst, std::abs(y[i] - x[i] - offset));
            CHECK(worst < 1e-11 * scale);
          };
          compare(field::Velocity::info, last, shift, shift);
          compare(field::Position::info, last, shift * rest.sim->dt(), 1);
          compare(field::Density::info, 0, 0, kDensity);
          compare(field::Pressure::info, 0, 0, kBulk);
          for (int k = 0; k < 6; ++k) compare(field::DeviatoricStress::info, k, 0, kShear);
        });
  }

  TEST_CASE("linear momentum of a free body is constant: every scheme in every frame") {
    double worst = 0;
    for_each_scheme(
        [&](const std::string& frame, const Overrides& options, const std::string& name) {
          CAPTURE(name);
          Random random;
          Run run = start_text(block_scene(frame, is_3d(frame) ? 5 : 9, 18, "open", 5), options);
          randomize(run, field::Velocity::info, -20, 20, random);
          const Totals start = run.sim->totals();
          run_steps(run, 40);
          const Totals end = run.sim->totals();
          const int first = frame == "axisymmetric" ? 1 : 0;  // radial momentum is none
          for (int a = first; a < run.sim->geometry().dimension; ++a) {
            const auto k = static_cast<std::size_t>(a);
            const double change = std::abs(end.momentum[k] - start.momentum[k]) / (start.mass * 20);
            // The weights of gimp are differences of areas, divided by the width.
            CHECK(change < (name.find("gimp") == std::string::npos ? 1e-13 : 1e-10));
            worst = std::max(worst, change);
          }
          CHECK(end.mass == doctest::Approx(start.mass).epsilon(1e-14));
        });
    MESSAGE("largest change / (m v) " << worst);
  }
}
