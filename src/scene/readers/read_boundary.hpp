// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/readers/read_boundary.hpp
/// Conditions on the sides of the domain. Keys are x_min ... z_max; r_min and r_max are synonyms of
/// x_min and x_max in the 2D frames. In 3d r_max means the four sides about the axis, and r_min:
/// axis, which is no side there, is passed over with a note. `axis` is symmetry at the coordinate
/// 0.
#include "scene/readers/readers.hpp"

namespace krater::scene {

struct BoxInfo {
  double lower_r;  ///< lower side along the first axis as given [m]
  bool revolve;    ///< the box has two components and the frame is 3d
  bool known;      ///< false: the box itself is wrong, do not compare with it
};

/// Fills Scene::grid.boundary; `node` may be null.
Node read_boundary(const Node* node, const BoxInfo& box, Block& grid, Reading& reading);

}  // namespace krater::scene
