// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a coupled law is given and what it gives: strength, pressure and damage in one, where each
/// needs the others (concrete, ceramic). It stands in a material under `model`, in place of
/// strength, eos and damage. A coupled law owns its history (materials/law_state.hpp) and gives, by
/// `at(state)`, an object with
///   CoupledUpdate<Real, N> update(const CoupledStep<Real>&) const
/// beside doubles rho0 and c0, the reference density and the bulk sound speed at rest, and
///   static constexpr bool needs_shear_modulus = true    its elastic deviator has the material's G
///   static constexpr bool fails                         `failed` of the update means something
///   double largest_length() const      softening by an energy per area G_f (optional): the largest
///                                      width that does not snap back [m]; 0: softens by no energy
///   std::array<Derived, N> derived() const   constants made of the parameters, told (optional)
///   bool degrades() const              its first column is field::Damage d, and s = (1 - d) s~:
///                                      the trial is that of s~ (optional)
///   Real shear_modulus(state)          G varies with the state (optional; then no shear_modulus of
///                                      the material is needed)
/// The stage (stages/coupled_stage.hpp) does what no law should have to know: the objective trial,
/// work and energy, ledger, sound speed, failure.
#pragma once

#include <array>

#include "krater/core/tensor.hpp"
#include "krater/materials/eos/split.hpp"
#include "krater/materials/law.hpp"
#include "krater/materials/law_state.hpp"

namespace krater::inline KRATER_ISA {

template <class Real>
struct CoupledStep {
  Sym3<Real> trial;  ///< elastic trial of the deviator [Pa]
  Real q;            ///< sqrt(3/2 s:s) of it [Pa]
  Real strain;       ///< equivalent strain increment, elastic and plastic
  Real rho, v;       ///< density of the end [kg/m^3], and 1/rho
  Real energy;       ///< e of the start [J/kg]
  Real plastic_strain;
  double dt;    ///< [s]
  Real length;  ///< width over which softening localises [m]
};

/// The end of the step.
template <class Real, int N>
struct CoupledUpdate {
  Real q;                        ///< of the deviator, which is q/q_tr of its trial; at most q_tr
  Real plastic;                  ///< plastic strain of the step
  PressureSplit<Real> pressure;  ///< p = cold + thermal e
  Real least;                    ///< the pressure is not below [Pa]
  Real modulus;                  ///< rho c^2, the stiffest that a change of volume meets [Pa]
  Real crush;  ///< heat of the change of volume [J/kg]: its work less what unloading gives back
  std::array<Real, N> state;
  MaskOf<Real> failed;  ///< bears no tension any more; what is left of its deviator is the law's
};

/// catalogue.hpp's DerivedConstant, for laws.
struct Derived {
  const char* name;
  double value;
  const char* unit;
};

template <class Law>
concept Coupled = Law::family == Family::model;

template <class Law>
concept Fails = requires {
  requires Law::fails;
};

/// A coupled law that makes its shear modulus of its history.
template <class Law>
concept ShearOfState = OwnsState<Law> && requires(const Law& law) {
  law.shear_modulus(law.initial_state());
};

}  // namespace krater::inline KRATER_ISA
