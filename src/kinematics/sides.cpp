// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/sides.hpp"

#include <algorithm>
#include <cmath>

namespace krater {

Triple PushingSide::push(const Triple& v, double missing, int dimension) const {
  Triple out{};
  out[axis] = inwards * missing;
  double squares = 0;
  for (std::size_t t = 0; t < static_cast<std::size_t>(dimension); ++t)
    if (t != axis) squares += (v[t] - velocity[t]) * (v[t] - velocity[t]);
  const double slip = std::sqrt(squares);
  const double share = sticky ? 1 : slip > 0 ? std::min(1.0, friction * missing / slip) : 0;
  for (std::size_t t = 0; t < static_cast<std::size_t>(dimension); ++t)
    if (t != axis) out[t] = -share * (v[t] - velocity[t]);
  return out;
}

std::vector<PushingSide> pushing_sides(const DomainSides& domain) {
  std::vector<PushingSide> out;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(domain.frame)); ++a)
    for (std::size_t s = 0; s < 2; ++s) {
      const Boundary& side = domain.sides[a][s];
      const bool sticky = side.kind == BoundaryKind::sticky;
      if (!sticky && !side.pushes()) continue;
      const double plane = domain.planes[a][s];
      out.push_back({a, s == 0 ? 1.0 : -1.0, plane, side.friction, sticky, plane,
                     side.drives() ? side.velocity : Triple{}});
    }
  return out;
}

}  // namespace krater
