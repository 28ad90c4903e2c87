// SPDX-License-Identifier: GPL-3.0-or-later
// The deviator in one stage: sound material, default rate (compiled once per instruction-set
// level).
#include "krater/materials/stages/hyperelastic_stage.hpp"
#include "krater/materials/stages/strength_stage.hpp"
#include "materials/stage_makers.hpp"

namespace krater::inline KRATER_ISA {

Stage* make_strength(int index, const double* values, const MaterialConstants& constants,
                     Layout& layout) {
  return stage_of(AllLaws{}, index, [&]<class Law>() -> Stage* {
    if constexpr (WholeStress<Law>) {
      return new HyperelasticStage<Law>{make_law<Law>(values, constants), constants, layout};
    } else if constexpr (Law::family == Family::strength) {
      return new StrengthStage<Law>{make_law<Law>(values, constants), constants, layout};
    } else {
      return nullptr;
    }
  });
}

}  // namespace krater::inline KRATER_ISA
