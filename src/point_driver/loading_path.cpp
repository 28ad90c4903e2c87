// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/point_driver/loading_path.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace krater {

namespace {

using Eigen::Matrix3d;

/// Share of a triaxial path's steps in which the lateral stress is brought on.
constexpr double kConfiningShare = 0.1;

}  // namespace

Matrix3d strain_of(const Matrix3d& map) {
  const Matrix3d H = map * (Matrix3d::Identity() + 0.5 * map).inverse();
  return 0.5 * (H + H.transpose());
}

LoadingPath::LoadingPath(const PathOptions& path, int steps, double start_pressure, double modulus)
    : path_{path}, modulus_{modulus} {
  if (path.kind == PathKind::velocity_gradient || path.kind == PathKind::stretch) {
    add(path.kind == PathKind::stretch ? Kind::deformation : Kind::velocity_gradient, steps, 0,
        path.time);
    return;
  }
  if (path.kind == PathKind::release_isentrope) {
    add(Kind::confine, steps, -start_pressure, -path.pressure);
    return;
  }
  if (path.kind == PathKind::triaxial && path.lateral_stress.value_or(0) != 0)
    add(Kind::confine, std::max(1, static_cast<int>(std::lround(kConfiningShare * steps))),
        -start_pressure, *path.lateral_stress);
  const Kind kind = kind_of_turns();
  const int rest = std::max(steps - steps_, static_cast<int>(path.turns.size()));
  double total = 0, before = 0;
  for (const double turn : path.turns) {
    total += std::fabs(turn - before);
    before = turn;
  }
  before = 0;
  sign_ = path.turns.front() < 0 ? -1 : 1;
  for (const double turn : path.turns) {
    const double share = std::fabs(turn - before) / total * rest;
    const int count = std::max(1, static_cast<int>(std::lround(share)));
    if (kind == Kind::confine)  // a mean stress is negative in compression
      add(kind, count, -start_pressure - before, -start_pressure - turn);
    else
      add(kind, count, before, turn);
    before = turn;
  }
}

LoadingPath::Kind LoadingPath::kind_of_turns() const {
  if (path_.kind == PathKind::simple_shear) return Kind::shear;
  if (path_.kind != PathKind::hydrostatic) return Kind::stretch;
  return path_.by_pressure ? Kind::confine : Kind::swell;
}

void LoadingPath::add(Kind kind, int count, double from, double to) {
  legs_.push_back({kind, steps_, count, from, to});
  steps_ += count;
}

PathStep LoadingPath::step(int number) const {
  const auto leg = std::find_if(legs_.begin(), legs_.end(),
                                [number](const Leg& l) { return number < l.first + l.count; });
  const auto at = [&](int k) {
    return k == leg->count ? leg->to : leg->from + (leg->to - leg->from) * k / leg->count;
  };
  return in_leg(*leg, at(number - leg->first), at(number - leg->first + 1));
}

PathStep LoadingPath::in_leg(const Leg& leg, double a, double b) const {
  PathStep step;
  switch (leg.kind) {
    case Kind::stretch:
      step.dt = std::fabs(b - a) / path_.rate;
      step.map(0, 0) = std::expm1(b - a);
      if (path_.kind == PathKind::uniaxial_strain) break;
      if (path_.kind == PathKind::biaxial) {
        step.map(1, 1) = step.map(0, 0);
        step.control = Control::normal_stress;
        step.target = path_.lateral_stress.value_or(0);
        break;
      }
      step.control = path_.triaxiality ? Control::triaxiality : Control::lateral_stress;
      step.target =
          path_.triaxiality ? sign_ * *path_.triaxiality : path_.lateral_stress.value_or(0);
      break;
    case Kind::shear:
      step.dt = std::fabs(b - a) / path_.rate;
      step.map(0, 1) = b - a;
      break;
    case Kind::swell: {
      const double volume = std::log1p(b) - std::log1p(a);
      step.dt = std::fabs(volume) / path_.rate;
      step.map = std::expm1(-volume / 3) * Matrix3d::Identity();
      break;
    }
    case Kind::confine:
      step.dt = std::max(std::fabs(b - a), 1e-9 * modulus_) / modulus_ / path_.rate;
      step.control = Control::mean_stress;
      step.target = b;
      break;
    case Kind::velocity_gradient: {
      // Implicit midpoint: a spin stays a rotation, and H is dt L.
      step.dt = b - a;
      const Matrix3d half = 0.5 * step.dt * tensor(0.5 * (a + b));
      step.map = 2.0 * (Matrix3d::Identity() - half).inverse() * half;
      break;
    }
    case Kind::deformation: {
      step.dt = b - a;
      const Matrix3d before = tensor(a);
      step.map = (tensor(b) - before) * before.inverse();
      break;
    }
  }
  return step;
}

Matrix3d LoadingPath::tensor(double t) const {
  Matrix3d value;
  for (int k = 0; k < 9; ++k) value(k / 3, k % 3) = path_.tensor[static_cast<std::size_t>(k)](t);
  return value;
}

}  // namespace krater
