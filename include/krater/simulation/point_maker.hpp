// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file simulation/point_maker.hpp
/// The record of a new material point: position, velocity of its body's field, mass, domain, and
/// what the laws start from.
#include <vector>

#include "krater/simulation/body.hpp"

namespace krater {

/// Looks its columns up once, for all points of a body.
class PointMaker {
 public:
  PointMaker(const Scene& scene, int body, const Body& of);
  /// stride/8 doubles, until the next point. Throws InputError where the velocity is not finite.
  std::vector<double>& make(const SeedPoint& seed, std::size_t id);
  /// The velocity of the body's field where a part of a point lies, which is `share` as long.
  void set_motion(std::vector<double>& record, const SeedPoint& whole, double share);

 private:
  struct Slots {
    int id, mass, position, reference, configuration, map, velocity, grid_velocity, affine,
        half_width, domain, load_share, deformation;
  };
  void set(int slot, int component, double value);
  void place(const SeedPoint& seed);
  void move(const SeedPoint& seed);
  void spin(const SeedPoint& seed);

  const Scene& scene_;
  const BodyOptions& options_;
  Slots slots_;
  double density_;
  std::vector<int> loads_;
  std::vector<double> blank_, record_;
};

}  // namespace krater
