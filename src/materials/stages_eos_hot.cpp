// SPDX-License-Identifier: GPL-3.0-or-later
// Pressure, and temperature from the energy (compiled once per instruction-set level).
#include "krater/materials/stages/burn_stage.hpp"
#include "krater/materials/stages/cohesion_stage.hpp"
#include "krater/materials/stages/energy_heating_stage.hpp"
#include "krater/materials/stages/eos_stage.hpp"
#include "krater/materials/stages/heat_floor_stage.hpp"
#include "materials/stage_makers.hpp"

namespace krater::inline KRATER_ISA {

namespace {

/// A law whose gamma0 may be zero and is: its stage books the work as that of a barotropic law
/// does, for all the energy of matter without a heat floor is held against it (Audit::unfelt). A
/// type of its own, so that no other scene pays for the sum.
template <class Law>
struct Unheated : Law {
  static constexpr bool barotropic = true;
};

template <Tension tension, class Law>
Stage* make_dilating(const Law& law, const EosRequest& r, Layout& layout) {
  if (r.dilates) return new EosStage<Law, tension, true>{law, r.spall_strength, layout};
  return new EosStage<Law, tension, false>{law, r.spall_strength, layout};
}

template <class Law, Tension tension>
Stage* make_tensile(const EosRequest& r, Layout& layout) {
  const Law law = make_law<Law>(r.values, r.constants);
  if constexpr (requires { law.gamma0; }) {
    if (!feels_energy(matter_of(law))) return make_dilating<tension>(Unheated<Law>{law}, r, layout);
  }
  return make_dilating<tension>(law, r, layout);
}

template <class Law>
Stage* make_heating_of(const Law& law, const EnergyHeatingRequest& r, Layout& layout) {
  if (r.carries)
    return new EnergyHeatingStage<Law, true>{law, r.c_v, r.degrades, r.constants, layout};
  return new EnergyHeatingStage<Law, false>{law, r.c_v, r.degrades, r.constants, layout};
}

template <class Law>
Stage* make_floor_of(const Law& law, Layout& layout) {
  if (!feels_energy(law)) return nullptr;
  return new HeatFloorStage<Law>{law, layout};
}

}  // namespace

Stage* make_eos(const EosRequest& r, Layout& layout) {
  return stage_of(AllLaws{}, r.law, [&]<class Law>() -> Stage* {
    if constexpr (Law::family == Family::eos) {
      switch (r.tension) {
        case Tension::own:
          return make_tensile<Law, Tension::own>(r, layout);
        case Tension::carried:
          return make_tensile<Law, Tension::carried>(r, layout);
        case Tension::parting:
          return make_tensile<Law, Tension::parting>(r, layout);
      }
    }
    return nullptr;
  });
}

StagesAround make_cohesion(int eos, const double* values, const MaterialConstants& constants,
                           Layout& layout) {
  StagesAround around;
  around.after = stage_of(AllLaws{}, eos, [&]<class Law>() -> Stage* {
    if constexpr (Parting<Law>) {
      const double rho0 = make_law<Law>(values, constants).rho0;
      around.before = new EffectiveCohesionStage{rho0, layout};
      return new CarriedCohesionStage{rho0, layout};
    }
    return nullptr;
  });
  return around;
}

Stage* make_burn(int eos, const double* values, const MaterialConstants& constants,
                 Layout& layout) {
  return stage_of(AllLaws{}, eos, [&]<class Law>() -> Stage* {
    if constexpr (Burns<Law>) return new BurnStage<Law>{make_law<Law>(values, constants), layout};
    return nullptr;
  });
}

Stage* make_heat_floor(int law, const double* values, const MaterialConstants& constants,
                       Layout& layout) {
  return stage_of(AllLaws{}, law, [&]<class Law>() -> Stage* {
    if constexpr (Law::family == Family::eos || requires(const Law& one) { one.solid; }) {
      return make_floor_of(matter_of(make_law<Law>(values, constants)), layout);
    } else {
      return nullptr;
    }
  });
}

Stage* make_energy_heating(const EnergyHeatingRequest& r, Layout& layout) {
  return stage_of(AllLaws{}, r.eos, [&]<class Law>() -> Stage* {
    if constexpr (Law::family == Family::eos) {
      return make_heating_of(matter_of(make_law<Law>(r.eos_values, r.constants)), r, layout);
    } else {
      return nullptr;
    }
  });
}

}  // namespace krater::inline KRATER_ISA
