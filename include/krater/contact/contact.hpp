// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/contact.hpp
/// Contact of velocity fields at nodes (theory 2, CCF (4)-(6)). Fields A and B with masses at a
/// node and the unit normal n from A to B exchange
///   J_n = m_A m_B/(m_A + m_B) (v_A - v_B).n > 0,   J_t = min(mu J_n, the sticking value)
/// against the slip, +J and -J, while they approach and touch; after the forces, before the walls.
/// Linear and angular momentum are exact: both impulses act at one node. First contact on the grid
/// is inelastic; its loss is heat of the node, once for all fields (contact/impulse_heat.hpp).
///
/// Filling. phi_k = sum S V_p / (volume that S covers), 1 where body k fills the node; at closed
/// sides the covered volume ends at the plane and phi is mirrored.
/// Joint: of the node and those around it the one with the largest min(phi_A, phi_B), the nearest
/// of those that are equal, their mean where several are as near: what mirrors, mirrors. Normal and
/// gap are judged there, for in the tail of a body its gradient means nothing.
/// Normal: n ~ w_B grad phi_B - w_A grad phi_A, with the lengths of central differences smoothed
/// across and the directions of planes through the faces (contact/face_plane.hpp), as far as these
/// are flat. With their trust t in [0, 1], w = t^4 + 1 - max(t_A^4, t_B^4): a flat face decides
/// against a corner, equal ones are averaged, and of two corners the difference counts, in which
/// what both lean aside cancels; of a fluid and a solid the solid decides, for a fluid's points lie
/// anyhow. `normal: logistic_regression` takes n from the points instead
/// (contact/contact_regression.hpp), where neither body decides. In nodes of a plane that mirrors n
/// keeps no component across it.
/// Touching (contact/contact_joint.cpp): bodies are apart as soon as one grid axis parts them.
/// Along each axis that has A on one side of the joint and B on the other, either body's reach
/// comes from its own three fillings:
///   reach = 1.6 (phi(0) - (phi(-1) + phi(1))/2) / (phi(-1) - phi(1)),
/// a face's place whatever part of the node's width the body takes, so that corners, edges and
/// faces are one. They touch when the widest gap, -reach_A - reach_B, is below 0.05 cells. The
/// volume criterion, sum phi > 1 - tol, is this one where both bodies are wide.
/// A rigid body holds the nodes at most half a cell beyond its face. Further out a node has of it
/// no more than the tail of its points, and by that a mass without end would hold the node as well
/// as if it stood there: to all that flows around it a body of radius r was one of r + h (force on
/// an ogive in metal, 3 to 24 cells in the radius). The outermost nodes that are held now lie half
/// a cell on either side of the face, in the mean on it.
/// Three and more fields: pairs in fixed order, three sweeps.
///
/// Rigid fields (contact/rigid.hpp) count as of infinite mass and move with their own velocity at
/// the node, two of them pass through each other. What a free body receives changes its velocity u
/// in the same step; the nodes must meet the changed one, or contact with much mass would throw a
/// light body back with energy that is not there. So u is foretold, implicitly in the impulses:
///   (1 + M^-1 K) du = M^-1 J(u),  K = sum m A^T P A,  A u = V + omega x r,
/// P = n n^T where it slides, 1 where it sticks; then the impulses with u + du are exchanged and
/// summed in fixed order, so that momentum is exact whatever was foretold.
#include <cstdint>
#include <vector>

#include "krater/contact/boundary.hpp"
#include "krater/contact/impulse_heat.hpp"
#include "krater/contact/impulses.hpp"
#include "krater/contact/rigid.hpp"
#include "krater/contact/rigid_meeting.hpp"
#include "krater/points/columns.hpp"

namespace krater {

/// What contact did in one step.
struct ContactWork {
  double change = 0;        ///< of kinetic energy, rigid bodies included [J]
  double friction = 0;      ///< work of the tangential impulses, part of `change` [J]
  double nodes = 0;         ///< pairs that pushed
  double driven = 0;        ///< work of prescribed rigid bodies on others, part of `change` [J]
  Triple driven_impulse{};  ///< of what drives them, and ...
  Triple held_impulse{};    ///< ... of the planes along which free ones move [N s]
  void add(const ContactWork& o) {
    change += o.change;
    friction += o.friction;
    nodes += o.nodes;
    driven += o.driven;
    for (std::size_t a = 0; a < 3; ++a) {
      driven_impulse[a] += o.driven_impulse[a];
      held_impulse[a] += o.held_impulse[a];
    }
  }
};

class ContactSet {
 public:
  /// `hoop`: axisymmetric frame. `linear`: linear shape functions.
  ContactSet(const GridGeometry& geometry, const BoundaryConditions& conditions, bool hoop,
             bool linear, const ContactOptions& options);
  bool active() const { return options_.active; }
  void note_impulses() { notes_ = true; }  ///< from now on
  /// Pairs of which neither body is listed meet elsewhere.
  void only_pairs_with(std::vector<bool> by_body) { listed_ = std::move(by_body); }
  void set_fluids(std::vector<bool> by_body) { fluids_ = std::move(by_body); }
  /// Find the blocks that fields share; after BlockGrid::rebuild().
  void relink(const BlockGrid& grid);
  /// Change v+ and dv of [v+, m, dv, V] where fields touch, and the velocities of free rigid
  /// bodies unless the nodes are only those of a projection. Field k is body k.
  ContactWork apply(BlockGrid& grid, const std::vector<PointColumns>& columns, RigidBodies& rigid,
                    bool projection = false);
  /// What the pushes of the last call took from motion becomes heat of the nodes, which hold k
  /// (contact/impulse_heat.hpp); returns it [J]. When every v+ is final.
  double heat();
  /// Adds what bodies gave each other in the last call, if it was noted.
  void give(Impulses& impulses) const;
  /// phi of a field at a node, by its storage index; 0 where it has none. While nodes hold volumes.
  double filling(const BlockGrid& grid, const std::array<int, 3>& index, FieldId field) const;
  /// What a body that fills the space about a node has there: the volume that its function covers
  /// in the domain [m^3].
  double whole_volume(const GridGeometry& geometry, const std::array<int, 3>& index) const;
  std::size_t shared_blocks() const { return groups_.size(); }

 private:
  struct Contact {
    int node;  ///< in the block
    int a, b;  ///< fields of the group
    std::array<double, 3> normal;
    bool even;  ///< both bodies are about as wide at the joint
    std::array<bool, 2> fluid, rigid;
  };
  /// Padded nodes where two bodies meet, seen from one of them.
  struct Joint {
    int count;
    std::array<int, 12> nodes;  ///< as many are at one distance at most
  };
  /// What one group does to one rigid body: impulses, or what foretells them.
  struct RigidShare {
    int body = -1;
    RigidImpulse sum;
    ForetoldPush foretold;
  };
  /// What a rigid body gives one node, whose loss it shares.
  struct RigidPush {
    std::size_t loss;
    int body;
    Eigen::Vector3d place, impulse;
  };
  struct Group {
    std::size_t first;                  ///< of the node blocks with one key ...
    int fields;                         ///< ... one per field
    bool counted = true;                ///< in the sums of this rank
    std::vector<std::int32_t> sources;  ///< per field and padded node: node in memory, -1: none;
                                        ///< linked when two bodies first share a node
    std::vector<double> inverse;        ///< 1/covered volume, per padded node
    std::vector<Contact> contacts;      ///< of the step, in order of their nodes
    std::vector<RigidShare> shares;     ///< of the step
    ImpulseHeat heat;                   ///< of the step
    std::vector<RigidPush> rigid_pushes;
    std::vector<ImpulseSum> given;  ///< of the step, if it is noted
    void begin_step() {
      contacts.clear();
      shares.clear();
      heat.clear();
      rigid_pushes.clear();
      given.clear();
    }
  };
  struct Before {
    double* node;
    std::array<double, 3> velocity;
  };
  /// Gradient of a filling at a joint.
  struct Slope {
    std::array<double, 3> gradient{};  ///< [1/cell]
    double trust = 0;                  ///< in its direction, 0 to 1
    std::uint64_t of = 0;              ///< which filling
  };
  struct Scratch {
    std::vector<double> filling;  ///< per field, padded on each side
    std::vector<Slope> slopes;    ///< at the same nodes, found when first asked for
    std::uint64_t fillings = 0;   ///< until now
    std::vector<Before> before;   ///< fields of a node, before they push
  };
  /// A deformable field's node, struck by a rigid body.
  struct Strike {
    double* node;
    int body;
    std::array<double, 3> normal;  ///< out of the rigid body
    std::array<double, 3> place;   ///< of the node [m]
    double friction;
  };
  struct AxisLink {
    int slot, local;  ///< neighbour 0..2 along the axis, node in it
    double inverse;   ///< 1/covered
  };
  using AxisLinks = std::array<std::array<AxisLink, 14>, 3>;
  const GridGeometry& geometry(int level) const {
    return geometries_[static_cast<std::size_t>(level)];
  }
  /// Radius of the windows that planes of faces are fitted in [cells]: the wider the less they
  /// feel the lattice; in 3D the 27 nodes of one cell are enough.
  int window() const { return geometry_.dimension == 3 ? 1 : 2; }
  int halo() const { return window() + 1; }  ///< nodes around a block, for a joint is one off
  AxisLinks axis_links(const BlockKey& key) const;
  double covered(const GridGeometry& geometry, int axis, int index) const;
  bool is_fluid(int body) const {
    return static_cast<std::size_t>(body) < fluids_.size() &&
           fluids_[static_cast<std::size_t>(body)];
  }
  bool may_meet(int body_a, int body_b) const {
    return listed_.empty() || listed_[static_cast<std::size_t>(body_a)] ||
           listed_[static_cast<std::size_t>(body_b)];
  }
  int mirrored(const GridGeometry& geometry, int axis, int index) const;
  void find_contacts(const BlockGrid& grid, const std::vector<PointColumns>& columns, Group& group,
                     Scratch& scratch, const RigidBodies& rigid) const;
  void refine(const BlockGrid& grid, const std::vector<PointColumns>& columns, const Group& group,
              const Joint& joint, Contact& contact) const;
  Joint joint_of(const Scratch& scratch, int at, const Contact& contact) const;
  template <class Touch>
  void exchange_node(BlockGrid& grid, Group& group, std::size_t first, std::size_t end,
                     const Touch& touch) const;
  ContactWork exchange_group(BlockGrid& grid, Group& group, const RigidBodies& rigid) const;
  ContactWork total() const;
  void hand_over(RigidBodies& rigid, ContactWork& sum);
  void foretell(const BlockGrid& grid, RigidBodies& rigid);
  Strike strike_of(const BlockGrid& grid, const Group& group, const Contact& contact,
                   bool a_is_rigid) const;
  void probe(const Strike& strike, const RigidTwist& twist, RigidShare& share) const;
  Triple exchange(const Strike& strike, const RigidTwist& twist, Group& group,
                  ContactWork& sum) const;  ///< returns the impulse on the node
  static RigidShare& share_of(Group& group, int body);
  void link(const BlockGrid& grid, Group& group) const;
  void fill(const BlockGrid& grid, const Group& group, Scratch& scratch) const;
  Slope slope_at(const double* phi) const;
  Slope slope_at(Scratch& scratch, int field, const Joint& joint) const;
  Joint joint_near(const double* phi_a, const double* phi_b, int at) const;
  double gap(const double* phi_a, const double* phi_b) const;
  double beyond(const double* phi, int at, const Joint& joint,
                const std::array<double, 3>& outward) const;
  bool find_contact(Scratch& scratch, int at, Contact& contact) const;
  bool keep_in_planes(const BlockKey& key, Contact& contact) const;
  /// Returns the impulse on a.
  Triple exchange(double* a, double* b, const Contact& contact, double mu, ContactWork& sum) const;

  GridGeometry geometry_;
  std::vector<GridGeometry> geometries_;  ///< of all levels
  BoundaryConditions conditions_;
  bool hoop_, linear_;
  ContactOptions options_;
  bool notes_ = false;
  std::vector<bool> listed_;                ///< by body, of pairs that meet; empty: all
  std::vector<bool> fluids_;                ///< by body; beyond the list: no
  int edge_, padded_, stride_[3]{}, size_;  ///< block edge; padded edge, strides and size
  std::vector<Group> groups_;
  std::vector<RigidTwist> twists_;  ///< by body: velocities that nodes meet in this step
  mutable std::vector<Scratch> scratch_;
  std::vector<ReproducibleSum> heats_;
  std::vector<ContactWork> results_;
};

}  // namespace krater
