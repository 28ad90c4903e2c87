// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file
/// How several ranks begin and end a run together: the first one runs it, the others follow.
#include <string>

namespace krater {

/// Ranks go on together or not at all: one that cannot begin says so by not coming to agree(). What
/// keeps it is heard where the first rank has nothing to say itself.
class Readiness {
 public:
  Readiness() = default;
  Readiness(const Readiness&) = delete;
  Readiness& operator=(const Readiness&) = delete;
  ~Readiness();
  /// Throws InputError where another rank could not begin, or has another scene.
  void agree(const std::string& scene);

 private:
  bool agreed_ = false;
};

}  // namespace krater
