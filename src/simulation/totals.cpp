// SPDX-License-Identifier: GPL-3.0-or-later
// Totals over the points for every row of history: a lane group at a time, for each of its columns
// is a line of the cache. The padding has no mass (points/store.hpp) and adds nothing.
#include <Eigen/Core>

#include "krater/core/parallel.hpp"
#include "krater/grid/support.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

namespace {

using Lanes = Eigen::Array<double, kLanes, 1>;

/// A lane group's columns by their places (points/store.hpp). Those of a group to come are asked
/// for: some lines out of every record are a pattern that the processor does not foresee.
class GroupColumns {
 public:
  GroupColumns(const PointStore& points, int group)
      : record_{points.data() +
                static_cast<std::size_t>(group) * static_cast<std::size_t>(points.stride())},
        ahead_{kAhead * points.stride()} {}
  Eigen::Map<const Lanes, Eigen::Aligned64> operator[](int place) const {
    __builtin_prefetch(record_ + place + ahead_);
    return Eigen::Map<const Lanes, Eigen::Aligned64>{record_ + place};
  }

 private:
  static constexpr int kAhead = 4;  // groups
  const double* record_;
  std::ptrdiff_t ahead_;
};

/// Of the affine part about a point, over m h^2/4: angular momentum in the plane of the grid axes 0
/// and 1. The lever is F (X_I - X_p), with F = I on the current configuration.
Lanes affine_spin(const GroupColumns& p, const PointColumns& c, int dim) {
  if (c.map < 0) return p[c.affine + kLanes * dim] - p[c.affine + kLanes];
  Lanes spin = Lanes::Zero();
  for (int a = 0; a < dim; ++a)
    spin += p[c.map + kLanes * a] * p[c.affine + kLanes * (dim + a)] -
            p[c.map + kLanes * (dim + a)] * p[c.affine + kLanes * a];
  return spin;
}

}  // namespace

Totals& Totals::operator+=(const Totals& other) {
  count += other.count;
  mass += other.mass;
  kinetic += other.kinetic;
  internal += other.internal;
  for (std::size_t a = 0; a < 3; ++a) momentum[a] += other.momentum[a];
  angular_momentum += other.angular_momentum;
  deviatoric += other.deviatoric;
  return *this;
}

Totals Simulation::totals_of_set(int s) const {
  Totals t = s < mesh_sets()      ? totals_of_mesh(s)
             : s < first_points() ? totals_of_particles(s)
                                  : totals_of_patch(s);
  t.deviatoric = deviatoric_energy_of_set(s);
  return t;
}

Totals Simulation::totals_of_patch(int s) const {
  const Patch& patch = grid_.patches()[static_cast<std::size_t>(s - first_points())];
  const PointColumns& c = kernel_data_[static_cast<std::size_t>(patch.body)].columns;
  const double h = geometry_of(s).h, moment = Support::moment * h * h;
  const int dim = geometry_.dimension;
  Lanes mass = Lanes::Zero(), twice = mass, internal = mass, spin = mass;
  std::array<Lanes, 3> momentum{mass, mass, mass};
  for (int g = 0; g < patch.points.groups(); ++g) {
    const GroupColumns p{patch.points, g};
    const Lanes m = p[c.mass];
    mass += m;
    Lanes square = Lanes::Zero();
    for (int a = 0; a < dim; ++a) {
      const Lanes v = p[c.velocity + kLanes * a];
      square += v * v;
      momentum[static_cast<std::size_t>(a)] += m * v;
    }
    if (c.energy >= 0) internal += m * p[c.energy];
    if (c.carried >= 0) internal += m * p[c.carried];
    spin += m * (p[c.position] * p[c.velocity + kLanes] - p[c.position + kLanes] * p[c.velocity]);
    if (c.affine >= 0) {
      Lanes affine = Lanes::Zero();
      for (int k = 0; k < dim * dim; ++k) affine += p[c.affine + kLanes * k].square();
      square += moment * affine;
      spin += moment * m * affine_spin(p, c, dim);
    }
    twice += m * square;
  }
  Totals t;
  t.count = patch.points.count();
  t.mass = mass.sum();
  t.kinetic = 0.5 * twice.sum();
  t.internal = internal.sum();
  for (int a = 0; a < dim; ++a)
    t.momentum[static_cast<std::size_t>(a)] = momentum[static_cast<std::size_t>(a)].sum();
  t.angular_momentum = spin.sum();
  return t;
}

/// Elastic energy of the deviator, sum m s:s/(4 G (1 - phi) rho) [J].
double Simulation::deviatoric_energy_of_set(int s) const {
  const PointSet points = set(s);
  const Body& body = *bodies_[static_cast<std::size_t>(points.body)];
  const int dev = kLanes * body.slot(field::DeviatoricStress::info),
            m = kLanes * body.slot(field::Mass::info),
            rho = kLanes * body.slot(field::Density::info),
            phi = body.degrades() ? kLanes * body.slot(field::Damage::info) : -1;
  const double G = body.material().shear_modulus;
  if (dev < 0 || G <= 0) return 0;
  Lanes sum = Lanes::Zero();
  for (int g = 0; g < points.points->groups(); ++g) {
    const GroupColumns p{*points.points, g};
    Lanes square = Lanes::Zero();
    for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * p[dev + kLanes * k].square();
    square *= p[m] / p[rho];
    sum += phi < 0 ? square : Lanes{square / (1 - p[phi])};
  }
  return sum.sum() / (4 * G);
}

/// Of all sets, in their order.
std::vector<Totals> Simulation::totals_by_set() const {
  if (ranks_ && !assembled_) {
    survey_together();
    return survey_;
  }
  std::vector<Totals> out(static_cast<std::size_t>(set_count()));
  for_each(out.size(), [&](std::size_t s) { out[s] = totals_of_set(static_cast<int>(s)); });
  return out;
}

std::vector<Totals> Simulation::totals_by_body() const {
  const std::vector<Totals> sets = totals_by_set();
  std::vector<Totals> out(bodies_.size());
  for (std::size_t s = 0; s < sets.size(); ++s)
    out[static_cast<std::size_t>(set(static_cast<int>(s)).body)] += sets[s];
  return out;
}

Totals Simulation::totals() const {
  Totals t;
  for (const Totals& body : totals_by_body()) t += body;
  return t;
}

}  // namespace krater
