// SPDX-License-Identifier: GPL-3.0-or-later
// What rows of history ask of all points: a lane group at a time, for each of its columns is a line
// of the cache. The padding has no mass (points/store.hpp), adds nothing, and lies on a point.
#include <Eigen/Core>

#include <algorithm>

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

/// What the elastic energy of the deviator is made of.
struct DeviatorColumns {
  int stress = -1, mass = -1, density = -1, damage = -1;
  double shear_modulus = 0;

  explicit DeviatorColumns(const Body& body)
      : stress{kLanes * body.slot(field::DeviatoricStress::info)},
        mass{kLanes * body.slot(field::Mass::info)},
        density{kLanes * body.slot(field::Density::info)},
        damage{body.degrades() ? kLanes * body.slot(field::Damage::info) : -1},
        shear_modulus{body.material().shear_modulus} {}
  bool any() const { return stress >= 0 && shear_modulus > 0; }
  /// Over 4 G. `volume`: of the points.
  Lanes energy(const GroupColumns& p, const Lanes& volume) const {
    Lanes square = Lanes::Zero();
    for (int k = 0; k < 6; ++k) square += (k < 3 ? 1 : 2) * p[stress + kLanes * k].square();
    square *= volume;
    return damage < 0 ? square : Lanes{square / (1 - p[damage])};
  }
};

/// The sums of a patch by lane.
class PatchSums {
 public:
  PatchSums(const PointColumns& columns, const DeviatorColumns& deviator, int dimension,
            double moment)
      : c_{columns}, deviator_{deviator}, dim_{dimension}, moment_{moment} {
    momentum_.fill(Lanes::Zero());
    low_.fill(Lanes::Constant(PointBounds::kNowhere));
    high_.fill(Lanes::Constant(-PointBounds::kNowhere));
  }
  void add(const GroupColumns& p) {
    add_motion(p);
    if (c_.energy >= 0) internal_ += p[c_.mass] * p[c_.energy];
    if (c_.carried >= 0) internal_ += p[c_.mass] * p[c_.carried];
    const Lanes volume = p[c_.mass] / p[deviator_.density];
    volume_ = volume_.max(volume);
    if (deviator_.any()) deviatoric_ += deviator_.energy(p, volume);
    for (int a = 0; a < dim_; ++a) {
      const auto k = static_cast<std::size_t>(a);
      low_[k] = low_[k].min(p[c_.position + kLanes * a]);
      high_[k] = high_[k].max(p[c_.position + kLanes * a]);
    }
  }
  PointSurvey survey() const;

 private:
  void add_motion(const GroupColumns& p) {
    const Lanes m = p[c_.mass];
    mass_ += m;
    Lanes square = Lanes::Zero();
    for (int a = 0; a < dim_; ++a) {
      const Lanes v = p[c_.velocity + kLanes * a];
      square += v * v;
      momentum_[static_cast<std::size_t>(a)] += m * v;
    }
    spin_ +=
        m * (p[c_.position] * p[c_.velocity + kLanes] - p[c_.position + kLanes] * p[c_.velocity]);
    if (c_.affine >= 0) {
      Lanes affine = Lanes::Zero();
      for (int k = 0; k < dim_ * dim_; ++k) affine += p[c_.affine + kLanes * k].square();
      square += moment_ * affine;
      spin_ += moment_ * m * affine_spin(p, c_, dim_);
    }
    twice_ += m * square;
  }

  const PointColumns& c_;
  const DeviatorColumns& deviator_;
  int dim_;
  double moment_;
  Lanes mass_ = Lanes::Zero(), twice_ = mass_, internal_ = mass_, spin_ = mass_,
        deviatoric_ = mass_, volume_ = mass_;
  std::array<Lanes, 3> momentum_, low_, high_;
};

PointSurvey PatchSums::survey() const {
  PointSurvey out;
  out.totals.mass = mass_.sum();
  out.totals.kinetic = 0.5 * twice_.sum();
  out.totals.internal = internal_.sum();
  out.totals.angular_momentum = spin_.sum();
  if (deviator_.any()) out.totals.deviatoric = deviatoric_.sum() / (4 * deviator_.shear_modulus);
  for (int a = 0; a < dim_; ++a) {
    const auto k = static_cast<std::size_t>(a);
    out.totals.momentum[k] = momentum_[k].sum();
    out.bounds.low[k] = low_[k].minCoeff();
    out.bounds.high[k] = high_[k].maxCoeff();
  }
  out.bounds.greatest_volume = volume_.maxCoeff();
  return out;
}

bool before(const BlockKey& a, int body_of_a, const BlockKey& b, int body_of_b) {
  return a != b ? a < b : body_of_a < body_of_b;
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

PointSurvey Simulation::survey_of_set(int s) const {
  if (s >= first_points()) {
    const auto patch = static_cast<std::size_t>(s - first_points());
    const PointSurvey* seen = seen_in_step(patch);
    return seen != nullptr ? *seen : survey_of_patch(patch);
  }
  PointSurvey out;
  out.totals = s < mesh_sets() ? totals_of_mesh(s) : totals_of_particles(s);
  const PointStore& points = *set(s).points;
  const DeviatorColumns deviator{*bodies_[static_cast<std::size_t>(set(s).body)]};
  if (!deviator.any()) return out;
  Lanes sum = Lanes::Zero();
  for (int g = 0; g < points.groups(); ++g) {
    const GroupColumns p{points, g};
    sum += deviator.energy(p, p[deviator.mass] / p[deviator.density]);
  }
  out.totals.deviatoric = sum.sum() / (4 * deviator.shear_modulus);
  return out;
}

PointSurvey Simulation::survey_of_patch(std::size_t p) const {
  const Patch& patch = grid_.patches()[p];
  const auto body = static_cast<std::size_t>(patch.body);
  const double h = grid_.geometry(patch.key.level).h;
  const DeviatorColumns deviator{*bodies_[body]};
  PatchSums sums{kernel_data_[body].columns, deviator, geometry_.dimension,
                 Support::moment * h * h};
  for (int g = 0; g < patch.points.groups(); ++g) sums.add({patch.points, g});
  PointSurvey out = sums.survey();
  out.totals.count = patch.points.count();
  return out;
}

// Points are read from memory once a step (kinematics/mpm/mpm_step_patches.cpp): the walk for a row
// of history follows the sweep of a patch while its points are in the cache. It holds while the
// patch has as many points: who left is out before, and who comes later is one more. Whoever
// changes points at their place, or takes some and adds others, clears all that was seen.
void Simulation::look_in_step(double dt) {
  if (!(time() + dt >= survey_due_ - 1e-3 * dt)) {
    step_->set_look({});
    return;
  }
  seen_.resize(grid_.patches().size());
  for (std::size_t p = 0; p < seen_.size(); ++p)
    seen_[p] = {grid_.patches()[p].key, grid_.patches()[p].body, -1, {}};
  step_->set_look([this, step = steps() + 1](std::size_t p) {
    seen_[p].found = survey_of_patch(p);
    seen_[p].step = step;
  });
}

/// By the patch's key: the step may have made patches and dropped others since.
const PointSurvey* Simulation::seen_in_step(std::size_t p) const {
  const Patch& patch = grid_.patches()[p];
  if (!patch.here) return nullptr;
  const auto at = std::lower_bound(
      seen_.begin(), seen_.end(), patch, [](const SeenPatch& seen, const Patch& looked_for) {
        return before(seen.key, seen.body, looked_for.key, looked_for.body);
      });
  if (at == seen_.end() || at->key != patch.key || at->body != patch.body) return nullptr;
  const bool holds = at->step == steps() && at->found.totals.count == patch.points.count();
  return holds ? &at->found : nullptr;
}

std::vector<PointSurvey> Simulation::survey() const {
  if (ranks_ && !assembled_) {
    survey_together();
    return survey_;
  }
  std::vector<PointSurvey> out(static_cast<std::size_t>(set_count()));
  for_each(out.size(), [&](std::size_t s) { out[s] = survey_of_set(static_cast<int>(s)); });
  return out;
}

std::vector<Totals> Simulation::totals_by_body(const std::vector<PointSurvey>& sets) const {
  std::vector<Totals> out(bodies_.size());
  for (std::size_t s = 0; s < sets.size(); ++s)
    out[static_cast<std::size_t>(set(static_cast<int>(s)).body)] += sets[s].totals;
  return out;
}

Totals Simulation::totals() const {
  Totals t;
  for (const Totals& body : totals_by_body()) t += body;
  return t;
}

}  // namespace krater
