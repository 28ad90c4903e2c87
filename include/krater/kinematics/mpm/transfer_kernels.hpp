// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/transfer_kernels.hpp
/// The kernels of one frame, shape and instruction-set level, put together (included by
/// kernels_*_hot.cpp only).
#include "krater/kinematics/mpm/gather_patch.hpp"
#include "krater/kinematics/mpm/nodes.hpp"

namespace krater::inline KRATER_ISA {

template <class Frame, class Shape, bool Affine, class Configuration>
class TransferKernels final : public Kernels {
 public:
  void scatter(Patch& patch, const BodyKernelData& body, const SweepSettings& s,
               const SweepScratch& w) const override {
    scatter_patch<Frame, Shape, Affine, Configuration>(patch, body, s, w);
  }
  void sum_tiles(const BlockGrid& grid, NodeBlock& block) const override {
    sum_block<Frame::dim>(grid, block);
  }
  void momentum(NodeBlock& block, const MomentumSettings& s) const override {
    update_block(block, s);
  }
  void work(NodeBlock& block, bool moments) const override { work_of_block(block, moments); }
  void gather(Patch& patch, const BlockGrid& grid, const BodyKernelData& body,
              const SweepSettings& s, const SweepScratch& w, GatherPart part) const override {
    if constexpr (Configuration::fixed) return run<GatherPart::all>(patch, grid, body, s, w);
    switch (part) {
      case GatherPart::all:
        return run<GatherPart::all>(patch, grid, body, s, w);
      case GatherPart::velocity_only:
        return run<GatherPart::velocity_only>(patch, grid, body, s, w);
      case GatherPart::strain_move:
        return run<GatherPart::strain_move>(patch, grid, body, s, w);
      case GatherPart::strain_only:
        return run<GatherPart::strain_only>(patch, grid, body, s, w);
      case GatherPart::velocity_move:
        return run<GatherPart::velocity_move>(patch, grid, body, s, w);
      case GatherPart::keep_only:
        return run<GatherPart::keep_only>(patch, grid, body, s, w);
      case GatherPart::filter_move:
        return run<GatherPart::filter_move>(patch, grid, body, s, w);
    }
  }
  void pressure(Patch& patch, const BlockGrid& grid, const BodyKernelData& body,
                const SweepSettings& s, const SweepScratch& w, PressurePart part) const override {
    const PressureSweep<Frame, Shape> sweep{patch, body.columns, s, w};
    load_halo<Frame::dim>(s.pressure_nodes, patch, w.pressure_halo);
    switch (part) {
      case PressurePart::collect:
        return collect_pressure(sweep);
      case PressurePart::force:
        return force_of_pressure(sweep);
      case PressurePart::dilatation:
        load_nodes<Frame::dim>(grid, patch, w.halo);
        return sum_dilatation(sweep);
    }
  }

 private:
  template <GatherPart Part>
  static void run(Patch& patch, const BlockGrid& grid, const BodyKernelData& body,
                  const SweepSettings& s, const SweepScratch& w) {
    gather_patch<Frame, Shape, Affine, Configuration, Part>(patch, grid, body, s, w);
  }
};

/// New kernels of one frame; ownership passes to the caller.
template <class Frame, class Configuration>
Kernels* make_transfer_kernels(KernelShape shape, bool affine) {
  switch (shape) {
    case KernelShape::linear:
      if (affine) return new TransferKernels<Frame, Linear, true, Configuration>;
      return new TransferKernels<Frame, Linear, false, Configuration>;
    case KernelShape::gimp:
      if (affine) return new TransferKernels<Frame, Gimp, true, Configuration>;
      return new TransferKernels<Frame, Gimp, false, Configuration>;
    case KernelShape::quadratic_bspline:
      break;
  }
  if (affine) return new TransferKernels<Frame, QuadraticBSpline, true, Configuration>;
  return new TransferKernels<Frame, QuadraticBSpline, false, Configuration>;
}

}  // namespace krater::inline KRATER_ISA
