// SPDX-License-Identifier: GPL-3.0-or-later
// Forces are adjoint to velocity gradients, a linear field is seen exactly by every point, and a
// rotation turns the stress: the kernels of a step taken apart.
#include <doctest/doctest.h>

#include "krater/contact/boundary.hpp"
#include "krater/kinematics/frames.hpp"
#include "verification/schemes_support.hpp"

namespace {

using namespace krater;
using namespace krater::test;

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
    zeros_.reserve(9 * kLanes), halo_.reserve(216 * kNodeDoubles),
        quadratics_.reserve(static_cast<std::size_t>(quadratic_doubles(3))),
        cells_.reserve(kCellDoubles);
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
    return {halo_.data(),  quadratics_.data(), nullptr,         local_[p].data(),  // no fluid
            cells_.data(), pressures_.data(),  leavers_.data(), zeros_.data()};
  }

  Run& run_;
  int dim_;
  BodyKernelData data_;
  BoundarySet boundary_;
  std::unique_ptr<Kernels> kernels_;
  SweepSettings settings_;
  AlignedBuffer zeros_, halo_, quadratics_, cells_, pressures_;
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
}
