// SPDX-License-Identifier: GPL-3.0-or-later
// Coupled laws (compiled once per instruction-set level).
#include "krater/materials/stages/coupled_stage.hpp"
#include "materials/stage_makers.hpp"

namespace krater::inline KRATER_ISA {

Stage* make_model(int index, const double* values, const MaterialConstants& constants,
                  Layout& layout) {
  return stage_of(AllLaws{}, index, [&]<class Law>() -> Stage* {
    if constexpr (Coupled<Law>) {
      return new CoupledStage<Law>{make_law<Law>(values, constants), layout};
    } else {
      return nullptr;
    }
  });
}

}  // namespace krater::inline KRATER_ISA
