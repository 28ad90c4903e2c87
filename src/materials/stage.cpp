// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/materials/stage.hpp"

#include <stdexcept>
#include <string>

#include "krater/materials/law_state.hpp"

namespace krater {

Stage::~Stage() = default;

void require_unowned(const Layout& layout, const FieldInfo& field, const char* law) {
  const Column* column = layout.find(field.name);
  if (column != nullptr && column->written)  // what was only asked for is still free
    throw std::logic_error(std::string{law} + ": the column '" + field.name +
                           "' belongs to another law already, or is declared twice");
}

}  // namespace krater
