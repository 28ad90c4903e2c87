// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/sph/sph_sweeps.hpp"

namespace krater::inline KRATER_ISA {

namespace {

template <int Dim, SphKernel Kind>
SphKernels* make(SphReference reference) {
  if (reference == SphReference::current) return new Sweeps<Dim, Kind, SphReference::current>;
  return new Sweeps<Dim, Kind, SphReference::initial>;  // adaptive ones differ in their data
}

template <int Dim>
SphKernels* make(SphKernel kernel, SphReference reference) {
  if (kernel == SphKernel::wendland_c2) return make<Dim, SphKernel::wendland_c2>(reference);
  if (kernel == SphKernel::quadratic) return make<Dim, SphKernel::quadratic>(reference);
  return make<Dim, SphKernel::cubic_spline>(reference);
}

SphKernels* make(const SphChoice& choice) {
  return choice.dimension == 2 ? make<2>(choice.kernel, choice.reference)
                               : make<3>(choice.kernel, choice.reference);
}

constexpr SphKernelFactory kFactory{make};

}  // namespace
}  // namespace krater::inline KRATER_ISA

namespace krater {
const SphKernelFactory* KRATER_CONCAT(sph_kernel_factory_, KRATER_ISA)() { return &kFactory; }
}  // namespace krater
