// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/errors.hpp
/// The two ways a run ends badly. `InputError`: the user can mend it (exit code 2), text reads
/// `FILE:LINE: path.to.key: problem (why) remedy`. `NumericalError`: the computation broke (exit
/// code 3), text names body, point, position, field and time; the state is written before the
/// program ends.
#include <stdexcept>

namespace krater {

struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace krater
