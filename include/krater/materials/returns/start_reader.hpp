// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What every stage of a strength law does the same way: read the state at the start of the step,
/// and open the voids of a dilatant law.
#pragma once

#include <type_traits>

#include "krater/materials/batch_access.hpp"
#include "krater/materials/returns/flow.hpp"

namespace krater::inline KRATER_ISA {

template <class Law>
concept ReadsTemperature = requires {
  requires Law::reads_temperature;
};

template <class Law>
class StartReader {
 public:
  StartReader(const MaterialConstants& constants, Layout& layout)
      : per_rho0_{1.0 / constants.density},
        volumes_{layout.local_input<field::SpecificVolumes>(Law::name)} {
    // Declared, never written here: without heating it is the constant initial temperature.
    if constexpr (ReadsTemperature<Law>)
      T_ = {layout.state<field::Temperature>(constants.initial_temperature, Law::name).offset};
  }

  /// `pressure`: read by laws that need it only.
  KRATER_FORCE_INLINE StartState<Pack> operator()(const BatchData& batch, int g,
                                                  Pack pressure) const {
    StartState<Pack> state{Pack(0.0)};
    if constexpr (ReadsTemperature<Law>) state.temperature = view(batch, T_)(g);
    if constexpr (ReadsPressure<Law>) {
      state.pressure = pressure;
      state.compression = Pack(per_rho0_) / view(batch, volumes_)(g, 0);
    }
    return state;
  }

 private:
  double per_rho0_;
  LocalInput<field::SpecificVolumes> volumes_;
  Input<field::Temperature> T_{-1};
};

/// Voids and least pressure of a dilatant law (strength/drucker_prager.hpp).
template <class Law>
class VoidOpener {
 public:
  explicit VoidOpener(Layout& layout)
      : voids_{layout.state<field::VoidVolume>(0.0, Law::name)},
        limit_{layout.local_output<field::TensionLimit>(Law::name)} {}

  /// By plastic strain `d` at specific volume `v`; returns what was opened [m^3/kg].
  KRATER_FORCE_INLINE Pack open(const BatchData& batch, int g, const Law& law, Pack d,
                                Pack v) const {
    const auto voids = view(batch, voids_);
    const Pack opened = law.bulking(voids(g), v) * d;
    voids.set(g, voids(g) + opened);
    view(batch, limit_).set(g, Pack(law.tension_limit()));
    return opened;
  }

 private:
  State<field::VoidVolume> voids_;
  LocalOutput<field::TensionLimit> limit_;
};

/// Laws without voids.
struct NoVoids {
  explicit NoVoids(Layout&) {}
};
template <class Law>
using VoidsOf = std::conditional_t<Dilatant<Law>, VoidOpener<Law>, NoVoids>;

/// Specific plastic work q d v, less the work of opening voids against the pressure.
KRATER_FORCE_INLINE Pack dilatant_work(Pack work, Pack pressure, Pack opened) {
  return max(Pack(0.0), fnma(pressure, opened, work));  // this order keeps a NaN
}

}  // namespace krater::inline KRATER_ISA
