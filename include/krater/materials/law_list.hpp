// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every law of the program, once: the catalogue and the stage factories are made from this list.
/// Adding a law is its header and its line here; an index into the list is what
/// `StageFactory::make` takes.
#pragma once

#include "krater/materials/damage/johnson_cook.hpp"
#include "krater/materials/damage/lemaitre.hpp"
#include "krater/materials/damage/strain_criteria.hpp"
#include "krater/materials/damage/tuler_butcher.hpp"
#include "krater/materials/eos/jwl.hpp"
#include "krater/materials/eos/jwl_burn.hpp"
#include "krater/materials/eos/linear.hpp"
#include "krater/materials/eos/mie_gruneisen_polynomial.hpp"
#include "krater/materials/eos/mie_gruneisen_shock.hpp"
#include "krater/materials/eos/p_alpha.hpp"
#include "krater/materials/eos/stiffened_gas.hpp"
#include "krater/materials/eos/tillotson.hpp"
#include "krater/materials/heating/internal_energy.hpp"
#include "krater/materials/heating/plastic_work.hpp"
#include "krater/materials/model/cscm.hpp"
#include "krater/materials/model/drucker_prager_cap.hpp"
#include "krater/materials/model/holmquist_johnson_cook.hpp"
#include "krater/materials/model/johnson_holmquist_2.hpp"
#include "krater/materials/model/karagozian_case.hpp"
#include "krater/materials/model/kinetic_damage.hpp"
#include "krater/materials/model/osborn.hpp"
#include "krater/materials/model/rht.hpp"
#include "krater/materials/strength/drucker_prager.hpp"
#include "krater/materials/strength/elastic.hpp"
#include "krater/materials/strength/johnson_cook.hpp"
#include "krater/materials/strength/neo_hookean.hpp"
#include "krater/materials/strength/steinberg_guinan.hpp"
#include "krater/materials/strength/voce.hpp"
#include "krater/materials/strength/von_mises.hpp"
#include "krater/materials/strength/zerilli_armstrong.hpp"
#include "krater/materials/viscosity/bulk_viscosity.hpp"

namespace krater::inline KRATER_ISA {

template <class... Laws>
struct LawList {
  static constexpr int size = sizeof...(Laws);
};

using AllLaws = LawList<Elastic,                 //
                        VonMises,                //
                        JohnsonCook,             //
                        Voce,                    //
                        VoceLog,                 //
                        ZerilliArmstrongFcc,     //
                        ZerilliArmstrongBcc,     //
                        SteinbergGuinan,         //
                        DruckerPrager,           //
                        NeoHookean,              //
                        LemaitreEnergy,          //
                        LemaitreThreshold,       //
                        JohnsonCookDamage,       //
                        JohnsonCookUncoupled,    //
                        CockcroftLatham,         //
                        MaximumPlasticStrain,    //
                        TulerButcher,            //
                        LinearEos,               //
                        MieGruneisenPolynomial,  //
                        MieGruneisenShock,       //
                        PAlpha,                  //
                        IdealGas,                //
                        StiffenedGas,            //
                        Jwl,                     //
                        JwlBurn,                 //
                        Tillotson,               //
                        HolmquistJohnsonCook,    //
                        Osborn,                  //
                        DruckerPragerCap,        //
                        KaragozianCase,          //
                        Cscm,                    //
                        Rht,                     //
                        KineticDamage,           //
                        JohnsonHolmquist2,       //
                        BulkViscosity,           //
                        PlasticWorkHeating,      //
                        EnergyHeating>;

}  // namespace krater::inline KRATER_ISA
