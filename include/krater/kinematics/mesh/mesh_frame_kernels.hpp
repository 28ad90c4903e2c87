// SPDX-License-Identifier: GPL-3.0-or-later
/// \file kinematics/mesh/mesh_frame_kernels.hpp
/// The sweeps of a frame, chosen for each body by what holds its hourglass and by its reference.
#pragma once

#include <type_traits>

#include "krater/kinematics/mesh/mesh_sweeps.hpp"

namespace krater::inline KRATER_ISA {

template <auto Value>
using Constant = std::integral_constant<decltype(Value), Value>;

/// work(kind, reference), both as constants.
template <class Work>
void choose(const ElementData& data, const Work& work) {
  const auto with = [&](auto kind) {
    if (data.reference == ElementReference::current)
      work(kind, Constant<ElementReference::current>{});
    else
      work(kind, Constant<ElementReference::initial>{});
  };
  if (data.held.kind == Holding::viscous)
    with(Constant<Holding::viscous>{});
  else if (data.held.kind == Holding::stiffness)
    with(Constant<Holding::stiffness>{});
  else
    with(Constant<Holding::assumed_strain>{});
}

template <class Frame>
class FrameMeshKernels final : public MeshKernels {
 public:
  void forces(const ElementData& data, int first, int last, ElementResult& out) const override {
    choose(data, [&](auto kind, auto on) {
      find_forces<Frame, kind.value, on.value>(data, first, last, out);
    });
  }
  void strain(const ElementData& data, const ElementScratch& scratch, double dt, int first,
              int last, ElementResult& out) const override {
    choose(data, [&](auto kind, auto on) {
      strain_elements<Frame, kind.value, on.value>(data, scratch, dt, first, last, out);
    });
  }
};

}  // namespace krater::inline KRATER_ISA
