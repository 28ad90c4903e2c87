// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// The particles of one body, as sph_step.hpp steps them.
#include <memory>
#include <vector>

#include "krater/kinematics/sph/neighbours.hpp"
#include "krater/kinematics/sph/sph_step.hpp"

namespace krater {

inline constexpr std::size_t kSphChange = 4;  ///< doubles of a particle's change

struct SphStep::Particles {
  SphBody made_of;
  SphColumns columns;
  PointStore points;
  std::unique_ptr<SphKernels> kernels;
  Neighbours neighbours;
  AlignedBuffer motion, load, correction, power, force, held, remembered, reference,
      reference_density, deformation, changes;
  AlignedBuffer first;  ///< as reference, at the start, where that is another
  AlignedBuffer areas;  ///< as force and held, of a stress of one (sph_loads.hpp)
  std::vector<std::vector<double>> standoff;  ///< of every pushing side, of every particle [m]
  std::size_t flat = 0;

  bool fixed() const { return made_of.options.reference != SphReference::current; }
  bool adaptive() const { return made_of.options.reference == SphReference::adaptive; }
  std::size_t group_count() const { return static_cast<std::size_t>(points.groups()); }
  double* change(int i) { return changes.data() + kSphChange * static_cast<std::size_t>(i); }
  Triple start(int i) const { return lanes_of(adaptive() ? first : reference, i); }
  Triple area(int i) const { return lanes_of(areas, i); }  ///< G [m^2]
  Triple vector(int column, int i, int dim) const {
    Triple out{};
    for (int a = 0; a < dim; ++a)
      out[static_cast<std::size_t>(a)] = points.at(column + kLanes * a, i);
    return out;
  }

 private:
  static Triple lanes_of(const AlignedBuffer& triples, int i) {
    const double* at = triples.data() + 3 * (i / kLanes) * kLanes + i % kLanes;
    return {at[0], at[kLanes], at[2 * kLanes]};
  }
};

}  // namespace krater
