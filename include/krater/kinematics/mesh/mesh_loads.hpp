// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/mesh_loads.hpp
/// Loads on bodies of elements: on the faces that are exposed, by their corners, and on all nodes.
///   pressure       f_I = -p int N_I n dA
///   traction       f_I = t int N_I n . N dA        N: outward axis of the load's `face`
///   velocity       v+ = v(t) of the faces' nodes, before contact and sides
///   body force     f_I = m_I b(x, X, t)
///   damping        f_I = -eta m_I (v- + v+)/2
/// over the faces as they are now. int N_I n dA = dV/dx_I: a body under pressure all around is in
/// equilibrium with the uniform stress -p to round-off. In axial symmetry dA holds 2 pi r; both by
/// two Gauss points along each edge, which is exact.
/// A face is loaded if it looked along N at the start and its middle lay in the load's region
/// there. Faces that erosion exposes are pressed too, inner ones that way included; other loads,
/// and those of a body whose elements become points, end with the elements of the start's faces:
/// points that elements became carry none. A pressure acts along the true normal, where points
/// (kinematics/mpm/node_loads.hpp), whose surface is not known, take N.
/// Masses and works: kinematics/load_changes.hpp.
#include <map>
#include <vector>

#include "krater/kinematics/audit.hpp"
#include "krater/kinematics/load_changes.hpp"
#include "krater/kinematics/load_options.hpp"
#include "krater/kinematics/mesh/mesh_step.hpp"

namespace krater {

class MeshLoads {
 public:
  MeshLoads(const LoadOptions& options, Acceleration body_force, Frame frame);

  bool any() const { return options_.any() || body_force_; }
  void set_time(double time) { time_ = time; }
  /// Some face of the body feels load `load` at the start.
  bool acts(std::size_t load, const MeshStep::Elements& body) const;
  /// Adds to the changes of velocity of a step, which hold those of the stress.
  void add(MeshStep::Elements& body, double dt);
  /// Works and impulses of the step, when all changes are final.
  void book(MeshStep::Elements& body, Audit& audit) const;

 private:
  struct Loaded {
    std::size_t load;
    std::array<std::int32_t, 4> face;
  };
  struct OfBody {
    std::size_t elements = ~std::size_t{0};  ///< when the faces were found
    std::vector<Loaded> faces;
    LoadChanges changes;
  };
  bool selects(const FaceLoad& load, const Mesh& mesh,
               const std::array<std::int32_t, 4>& face) const;
  void find_faces(const MeshStep::Elements& body, OfBody& out) const;
  void press(MeshStep::Elements& body, OfBody& of, double dt) const;
  LoadChanges::Masses masses(MeshStep::Elements& body) const;
  void drive(MeshStep::Elements& body, OfBody& of) const;

  LoadOptions options_;
  Acceleration body_force_;
  Frame frame_;
  double time_ = 0;
  std::map<const MeshStep::Elements*, OfBody> bodies_;
};

}  // namespace krater
