// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/yaml/expression.hpp
/// Vector fields given by constants or by expressions (muParser) in the current position x y z r,
/// the initial position X Y Z R, the time t and pi; SI in, SI out. Frame of the variables: 3d x, y,
/// z; plane strain x, z (y = 0); axisymmetric r = x, z (y = 0); r = sqrt(x^2 + y^2) everywhere.
/// Assumption: one thread at a time may call an expression field, for the parser keeps its
/// variables in the object.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "krater/scene/scene.hpp"

namespace krater {

std::shared_ptr<const FieldFunction> make_constant_field(const Triple& value);

/// One expression per grid axis. Throws InputError with the reason, without file and line.
std::shared_ptr<const FieldFunction> make_expression_field(
    Frame frame, const std::vector<std::string>& components);

/// A function of the time t alone (and pi). Throws InputError as above.
std::function<double(double)> make_time_function(const std::string& expression);

/// An expression of numbers by name, as `rod.kinetic_energy < 5 && time > 1e-5`; they are given in
/// the order of `names`. Throws InputError as above.
std::function<double(const std::vector<double>&)> make_table_function(
    const std::string& expression, const std::vector<std::string>& names);

}  // namespace krater
