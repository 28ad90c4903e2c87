// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/mesh_contact.hpp
/// Contact of bodies of elements: they meet at the nodes of a grid of their own, presented by
/// carriers q, samples of their exposed faces with area vector A_q N_q and the share
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
/// approach or 5e-4 cells a step. They never pull. The nodes get it back by the adjoint,
///   dv_I = 1/m_I sum_q m_qI sum_i S_iq dv_i,
/// which keeps momentum exactly and never gives energy; as it smooths over a cell, there are three
/// passes. What is lost of motion is heat of the nodes that were pushed, by m_I |dv_I|^2.
/// Angular momentum is kept but for what the two impulses of a node make, acting at xbar_A and
/// xbar_B. A body does not meet itself.
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "krater/contact/impulses.hpp"
#include "krater/contact/options.hpp"
#include "krater/geometry/frame.hpp"
#include "krater/kinematics/mesh/mesh.hpp"

namespace krater {

/// The nodes of a body, as a step holds them.
struct MeshNodes {
  int body;         ///< in the scene
  double* records;  ///< 8 per node: x, m, v, heat per mass of the step
  double* changes;  ///< 4 per node: dv of the step so far
  std::size_t count;
};

/// What contact did in a step.
struct MeshContactWork {
  double heat = 0;      ///< taken from motion [J]
  double friction = 0;  ///< work of the tangential impulses, about [J]
  double pairs = 0;     ///< places where two bodies pushed
};

class MeshContact {
 public:
  /// `cell`: of the grid on which bodies meet.
  MeshContact(Frame frame, double cell, const ContactOptions& options)
      : frame_{frame}, dim_{dimension(frame)}, cell_{cell}, options_{options} {}

  using Face = std::array<std::int32_t, 4>;
  /// The faces by which the next body meets others (exposed_faces(), without those on planes of
  /// symmetry).
  void add(std::vector<Face> faces) { faces_.push_back(std::move(faces)); }
  /// Changes dv of the nodes where bodies touch.
  void push(const std::vector<MeshNodes>& bodies, double dt);
  /// When every dv is final: what contact took from motion becomes heat of the nodes.
  MeshContactWork book(const std::vector<MeshNodes>& bodies);
  /// Adds what bodies gave each other in the last step.
  void give(Impulses& impulses) const { impulses.add(given_); }

  static constexpr std::size_t kSupport = 3;  ///< nodes of S along an axis

 private:
  struct Carrier {
    std::size_t body;  ///< among those given
    Face nodes;
    std::array<double, 4> share;  ///< m_qI
    std::size_t corners;
    Triple x, area;  ///< A N
    std::array<std::int64_t, 3> base;
    std::array<std::array<double, kSupport>, 3> weight;
    std::array<std::int32_t, 27> at;  ///< nodes of the grid, in order of their weights
  };
  /// A body at a node of the grid.
  struct Presence {
    Triple area{};
    double whole = 0;  ///< sum of areas
    bool here = false;
  };
  /// One side of a meeting.
  struct Side {
    std::size_t body = 0;
    double mass = 0, weight = 0;
    Triple place{}, momentum{}, change{};
  };
  /// Two bodies at a node of the grid.
  struct Meeting {
    std::int32_t node;
    std::array<Side, 2> side;
    Triple normal;  ///< from the first to the second
    double gap = 0;
    Triple impulse{};  ///< on the first, of the step
  };
  struct Touched {
    std::size_t body;
    std::int32_t node;
    Triple by_contact;  ///< dv
  };

  void find_carriers(const std::vector<MeshNodes>& bodies);
  void sample(const MeshNodes& nodes, std::size_t body, const Face& face);
  void share_masses(const std::vector<MeshNodes>& bodies);
  void number_nodes();
  void find_meetings();
  void weigh();
  /// dv of the nodes that may be pushed into by_contact, with a sign.
  void note_changes(const std::vector<MeshNodes>& bodies, double sign);
  void list_touched(const std::vector<MeshNodes>& bodies);
  void pass(const std::vector<MeshNodes>& bodies, double dt);
  void exchange(Meeting& meeting, double mu, double dt);
  double friction_between(const std::vector<MeshNodes>& bodies, const Meeting& meeting) const;
  std::size_t reached() const { return dim_ == 3 ? 27 : 9; }
  /// visit(meeting, side, S, A N . n outwards) for all that a carrier takes part in.
  template <class Visit>
  void for_each_meeting(const Carrier& carrier, const Visit& visit);

  Frame frame_;
  int dim_;
  double cell_;
  ContactOptions options_;
  std::vector<std::vector<Face>> faces_;
  // Of the step:
  std::vector<Carrier> carriers_;
  std::size_t grid_nodes_ = 0;
  std::vector<Presence> present_;            ///< per node of the grid and body
  std::vector<Meeting> meetings_;            ///< in order of nodes
  std::vector<std::int32_t> first_meeting_;  ///< per node of the grid, and the end
  std::vector<Touched> touched_;
  std::vector<ImpulsePair> given_;
  double friction_ = 0, pairs_ = 0;
};

}  // namespace krater
