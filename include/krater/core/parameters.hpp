// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/parameters.hpp
/// Declared model parameters: one declaration serves reading, range checks, `krater models` and the
/// manual.
#include <limits>

namespace krater {

/// Admissible values of a parameter.
enum class Range { any, positive, non_negative, fraction };

inline constexpr double kRequired = std::numeric_limits<double>::quiet_NaN();

/// What a user may set: key, SI unit, admissible range, default (`kRequired`: none) and meaning.
struct ParameterInfo {
  const char* key;
  const char* unit;  ///< SI unit in UDUNITS spelling, "1" for a pure number
  Range range;
  double fallback;  ///< default value, or kRequired
  const char* meaning;
  const char* alias = nullptr;  ///< a second spelling that is accepted
  /// "printed|critical": the value is one of these words, kept as its index (`fallback` too).
  const char* words = nullptr;
};

/// One parameter of a model and where its value is kept.
template <class Model>
struct Parameter {
  ParameterInfo info;
  double Model::*value;
};

}  // namespace krater
