// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file step/contact.hpp
/// Contact of velocity fields at nodes (theory 2, CCF (4)-(6)). Fields A and B with masses at a
/// node and the unit normal n from A to B exchange
///   J_n = m_A m_B/(m_A + m_B) (v_A - v_B).n > 0,   J_t = min(mu J_n, the sticking value)
/// against the slip, +J and -J, while they approach and touch; after the forces, before the walls.
/// Linear and angular momentum are exact: both impulses act at one node. First contact on the grid
/// is inelastic; its loss is booked, friction apart.
///
/// Filling. phi_k = sum S V_p / (volume that S covers), 1 where body k fills the node; at closed
/// sides the covered volume ends at the plane and phi is mirrored.
/// Joint: of the node and those around it the one with the largest min(phi_A,
/// phi_B); normal and gap are judged there, for in the tail of a body its gradient means nothing.
/// Normal: n ~ |grad phi_B|^20 grad phi_B - |grad phi_A|^20 grad phi_A, central differences
/// smoothed across: the steeper filling decides, for the gradient of a corner is weaker and points
/// aside; equal ones are averaged. `normal: logistic_regression` takes n
/// from the points instead (step/contact_regression.hpp). Touching: a gap is a valley of the total
/// filling along the grid axis nearest to n; they touch when phi(j) > (1 - kValley) (phi(j-1) +
/// phi(j+1))/2. The volume criterion of numerics A10, sum phi > 1 - tol, is this one where bodies
/// are wide; at the edge of a punch the filling falls off along the contact, and only the valley
/// tells a gap from an edge. Three and more fields: pairs in fixed order, three sweeps.
#include <cstdint>
#include <vector>

#include "krater/step/boundary.hpp"
#include "krater/step/kernels.hpp"

namespace krater {

/// What contact did in one step.
struct ContactWork {
  double work = 0;              ///< change of the grid's kinetic energy [J]
  double force_correction = 0;  ///< change of the work of the nodal forces, part of `work` [J]
  double friction = 0;          ///< work of the tangential impulses, part of `work` [J]
  double nodes = 0;             ///< pairs that pushed
  void add(const ContactWork& o) {
    work += o.work, force_correction += o.force_correction, friction += o.friction,
        nodes += o.nodes;
  }
};

class ContactSet {
 public:
  /// `hoop`: axisymmetric frame. `linear`: linear shape functions.
  ContactSet(const GridGeometry& geometry, const BoundaryConditions& conditions, bool hoop,
             bool linear, const ContactOptions& options);
  bool active() const { return options_.active; }
  /// Find the blocks that fields share; after BlockGrid::rebuild().
  void relink(const BlockGrid& grid);
  /// Change v+ and dv of [v+, m, dv, V] where fields touch. Field k is body k.
  ContactWork apply(BlockGrid& grid, const std::vector<BodyKernelData>& bodies);
  std::size_t shared_blocks() const { return groups_.size(); }

 private:
  struct Group {
    std::size_t first;                  ///< of the node blocks with one key ...
    int fields;                         ///< ... one per field
    std::vector<std::int32_t> sources;  ///< per field and padded node: node in memory, -1: none;
                                        ///< linked when two bodies first share a node
    std::vector<double> inverse;        ///< 1/covered volume, per padded node
  };
  struct Scratch {
    std::vector<double> filling;  ///< per field, padded by two nodes on each side
    bool filled = false;          ///< with the group at hand
  };
  struct Contact {
    int a, b;  ///< fields of the group
    std::array<double, 3> normal;
  };
  struct AxisLink {
    int slot, local;  ///< neighbour 0..2 along the axis, node in it
    double inverse;   ///< 1/covered
  };
  using AxisLinks = std::array<std::array<AxisLink, 12>, 3>;
  AxisLinks axis_links(const BlockKey& key) const;
  double covered(int axis, int index) const;
  int mirrored(int axis, int index) const;
  ContactWork touch_group(BlockGrid& grid, const std::vector<BodyKernelData>& bodies, Group& group,
                          Scratch& scratch) const;
  int find_contacts(BlockGrid& grid, const std::vector<BodyKernelData>& bodies, Group& group,
                    Scratch& scratch, int n, Contact* contacts) const;
  void refine(const BlockGrid& grid, const std::vector<BodyKernelData>& bodies, const Group& group,
              int n, Contact& contact) const;
  void link(const BlockGrid& grid, Group& group) const;
  void fill(const BlockGrid& grid, const Group& group, Scratch& scratch) const;
  std::array<double, 3> gradient(const double* phi) const;
  int joint_near(const double* phi_a, const double* phi_b, int at) const;
  bool find_contact(const Scratch& scratch, int fields, int at, Contact& contact) const;
  void exchange(double* a, double* b, const Contact& contact, double mu, ContactWork& sum) const;

  GridGeometry geometry_;
  BoundaryConditions conditions_;
  bool hoop_, linear_;
  ContactOptions options_;
  int edge_, padded_, stride_[3]{}, size_;  ///< block edge; padded edge, strides and size
  std::vector<Group> groups_;
  std::vector<Scratch> scratch_;
  std::vector<ContactWork> results_;
};

}  // namespace krater
