// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "krater/geometry/surfaces/triangles.hpp"

namespace krater {

/// Pairs of facets that meet elsewhere than at a common edge or vertex; the surface must be
/// manifold and consistently turned.
std::vector<std::pair<std::size_t, std::size_t>> self_intersections(const Triangles& triangles);

}  // namespace krater
