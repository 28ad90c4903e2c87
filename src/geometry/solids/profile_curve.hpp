// SPDX-License-Identifier: GPL-3.0-or-later
// A closed plane curve of straight edges and arcs: membership, crossings, support, moments.
#pragma once

#include <vector>

#include "krater/geometry/solids/profile.hpp"

namespace krater {

class ProfileCurve {
 public:
  /// Throws std::invalid_argument for a gap.
  explicit ProfileCurve(const Profile& profile);

  struct Piece {
    ProfileEdge edge;       ///< of an arc: monotonic in u and v
    double u_side, v_side;  ///< of an arc: its side of the centre, +-1
  };
  const std::vector<Piece>& pieces() const { return pieces_; }

  bool contains(double u, double v) const;  ///< even-odd
  /// All v at which the curve meets the line u = const are added, possibly twice at corners.
  void crossings_along_v(double u, std::vector<double>& out) const;
  double support(double du, double dv) const;  ///< greatest du u + dv v
  /// int u^a v^b dA; negative where the curve runs clockwise.
  double moment(int a, int b) const;

 private:
  void add(const ProfileEdge& e);
  std::vector<Piece> pieces_;
};

}  // namespace krater
