// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/mesh_contact.hpp
/// Contact of bodies of elements, with each other and with bodies of points: they meet at the nodes
/// of the grid, presented by carriers q, samples of their exposed faces with area vector A_q N_q
/// and the share
///   m_qI = m_I N_I(q) A_q / sum_q' N_I(q') A_q'
/// of the nodes I of the face. Nodes deep inside do not take part: were all of them pushed, bodies
/// would lose a fourth of their energy and creep into each other under a lasting load. At a node i
/// of the grid, with the quadratic B-spline S,
///   m = sum S m_q,   p = sum S sum_I m_qI v_I,   xbar = sum S w m_q x_q / sum S w m_q,
///   n ~ k_A^8 N_A/|N_A| - k_B^8 N_B/|N_B|,   N = sum S A_q N_q,   k = |N| / sum S A_q,
/// so that a face decides and not a corner, w = max(0, N_q . n)^2 the part that looks across; what
/// looks away (N_q . n < -1/2: the back of a thin plate) is no part of it. With the gap
/// g = (xbar_B - xbar_A) . n the bodies may come no nearer than g in a step:
///   J_n = m_A m_B/(m_A + m_B) max(0, (v_A - v_B) . n - g/dt),   J_t = min(mu J_n, sticking),
/// and where they overlap, g < 0, a tenth of it is taken back, not faster than a twentieth of their
/// approach or 1e-3 of the speed of sound. They never pull. The nodes get it back by the adjoint,
///   dv_I = 1/m_I sum_q m_qI sum_i S_iq dv_i,
/// which keeps momentum exactly and never gives energy; as it smooths over a cell, there are three
/// passes. What is lost of motion is heat of the nodes that were pushed, by m_I |dv_I|^2.
/// Angular momentum is kept but for what the two impulses of a node make, acting at xbar_A and
/// xbar_B. A body does not meet itself. At planes of symmetry the grid's sums are folded: what a
/// carrier has beyond is the image of what is inside.
///
/// Points. A node of their velocity field (contact/contact.hpp) is a side whose mass and velocity
/// are the node's own, pushed as it is. Its face lies where its filling phi says, along the grid
/// axis next to n (contact/joint_profile.hpp); the mesh's face is known, so only one of two is
/// found from fillings. With k_B of the mesh's faces, n = N_B/|N_B| where they are flat, and else
///   n ~ k_B^40 N_B/|N_B| + k_A^40 grad phi_A/|grad phi_A|,
/// k_A = |grad phi_A| by that of a flat face, at the node next to it: at corners and edges of the
/// mesh the points decide if they are flatter. Fillings miss a face by some hundredths of a cell:
/// closer than kTouch they touch, and an overlap is not taken back.
///
/// Rigid bodies of points are sides without inertia of their own (contact/rigid.hpp); velocities
/// that nodes meet are foretold in every pass.
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "krater/contact/contact.hpp"
#include "krater/contact/impulses.hpp"
#include "krater/contact/options.hpp"
#include "krater/geometry/frame.hpp"
#include "krater/kinematics/encounter.hpp"
#include "krater/kinematics/mesh/mesh_step.hpp"

namespace krater {

class MeshContact final : public PassingEncounter {
 public:
  /// What must outlive it. `grid` holds the velocity fields of all bodies of points, each its own;
  /// `lent`: another encounter fills it anew for every pass, and accounts for its nodes.
  struct Parts {
    MeshStep& mesh;
    BlockGrid& grid;
    const ContactSet& fillings;
    const BoundarySet& boundary;
    RigidBodies& rigid;
    Audit& audit;
    Impulses& impulses;
    double sound_speed;  ///< greatest of the bodies, undeformed [m/s]
    bool lent = false;
  };
  MeshContact(Frame frame, const ContactOptions& options, const Parts& parts);

  void push(double dt) override;
  Standing book() override;
  std::vector<BodyBox> boxes() const override;
  void begin() override;
  void pass(double dt) override;
  void end() override;
  EncounterLoss loss() const override;
  Standing warm(const EncounterLoss& all) override;

  static constexpr std::size_t kSupport = 3;  ///< nodes of S along an axis

 private:
  using Face = std::array<std::int32_t, 4>;
  using Index = std::array<int, 3>;  ///< of a node of the grid, as stored
  struct Reached {
    std::int32_t node;   ///< of those that carriers reach
    std::uint8_t flips;  ///< bit per axis: seen in the plane of symmetry across it
  };
  struct Carrier {
    std::size_t body;  ///< among those of elements
    Face nodes;
    std::array<double, 4> share;  ///< m_qI
    std::size_t corners;
    Triple x, area;  ///< A N
    Index base;
    std::array<std::array<double, kSupport>, 3> weight;
    std::array<Reached, 27> at;  ///< nodes of the grid, in order of their weights
    std::size_t first_link, last_link;
  };
  /// A carrier's part in a meeting; the same in all passes of a step.
  struct Link {
    std::uint32_t meeting;
    std::uint8_t side, flips;
    double S, across;  ///< A N . n outwards
  };
  /// A body at a node of the grid.
  struct Presence {
    Triple area{};
    double whole = 0;  ///< sum of areas
    bool here = false;
  };
  static constexpr std::size_t kPoints = ~std::size_t{0};
  /// One side of a meeting.
  struct Side {
    std::size_t body = kPoints;  ///< among those of elements
    int of_scene = -1;
    double* record = nullptr;  ///< of the node, of points
    double mass = 0, weight = 0;
    Triple place{}, momentum{}, change{};
  };
  /// Two bodies at a node of the grid; the second may be one of points.
  struct Meeting {
    std::int32_t node;
    std::array<Side, 2> side;
    Triple normal;  ///< from the first to the second
    double gap = 0;
    Triple impulse{};  ///< on the first, of the step
    bool rigid = false;
    std::array<bool, 3> held{};  ///< axes across which a plane of symmetry mirrors the node
  };
  /// A rigid body in a pass.
  struct RigidPart {
    int body;
    RigidTwist twist;                                                 ///< that its meetings find
    RigidImpulse sum;                                                 ///< on it
    std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pushes;  ///< place, impulse on others
  };
  struct Touched {
    std::size_t body;
    std::int32_t node;
    Triple by_contact;  ///< dv
  };

  void find_faces();
  void find_carriers();
  void sample(const MeshNodes& nodes, std::size_t body, const Face& face);
  void share_masses();
  void number_nodes();
  Reached inside(Index& index) const;
  void find_meetings();
  void meet_points(std::int32_t node, std::size_t body, const Presence& presence);
  bool find_normal(Meeting& meeting) const;
  void weigh();
  double reach_of_points(const Meeting& meeting, const Triple& face) const;
  Triple gradient_of_points(const Index& index, int body) const;
  std::array<double, 5> fillings_along(std::size_t axis, Index at, int body) const;
  double flatness_of_points(Index index, int body, Triple& inwards) const;
  Triple place_of_node(const Index& index) const;
  /// dv of the nodes that may be pushed into by_contact, with a sign.
  void note_changes(double sign);
  void list_touched();
  /// Its node is this encounter's to account for.
  bool accounts_for(const Meeting& meeting) const {
    return meeting.side[1].record != nullptr && !meeting.rigid && !parts_.lent;
  }
  void exchange(Meeting& meeting, double dt);
  double allowed(const Meeting& meeting, double closing, double dt) const;
  double friction_between(const Meeting& meeting) const;
  void note_impulses();
  void foretell(double dt);
  RigidMeeting meet(const Meeting& meeting, const RigidPart& part, double dt) const;
  RigidPart& rigid_part(int body);
  void exchange_rigid(Meeting& meeting, double dt);
  void hand_over();
  std::size_t reached() const { return dim_ == 3 ? 27 : 9; }
  void link_carriers();
  /// visit(link, side) for all that a carrier takes part in.
  template <class Visit>
  void for_each_link(const Carrier& carrier, const Visit& visit);

  Frame frame_;
  int dim_;
  double cell_;
  GridGeometry geometry_;
  BoundaryConditions conditions_;
  ContactOptions options_;
  Parts parts_;
  std::vector<std::vector<Face>> faces_;  ///< by which bodies of elements meet others
  std::size_t shape_ = 0;                 ///< of the meshes, when they were found
  // Of the step:
  std::vector<MeshNodes> bodies_;
  std::vector<int> of_points_;  ///< bodies of points near one of elements
  std::vector<Carrier> carriers_;
  std::vector<Link> links_;                  ///< carrier by carrier
  std::vector<Index> places_;                ///< nodes of the grid that carriers reach
  std::vector<Presence> present_;            ///< per node of the grid and body
  std::vector<Meeting> meetings_;            ///< in order of nodes
  std::vector<std::int32_t> first_meeting_;  ///< per node of the grid, and the end
  std::vector<Touched> touched_;
  std::vector<ImpulsePair> given_;
  std::vector<RigidPart> rigid_parts_;
  double friction_ = 0, pairs_ = 0, rigid_work_ = 0;
};

}  // namespace krater
