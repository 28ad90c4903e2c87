// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/impulse_heat.hpp
/// Heat of impulses at nodes: contact of fields, walls. What pushes changes v+ of some nodes by
/// dvJ_k; with the final v+ of the step, after everything that pushes, and vbar = v+ - dv/2 it
/// takes
///   D = W - sum_k m_k vbar_k . dvJ_k
/// from their motion, W the work of what pushed from outside (a driven side, a rigid body). D is
/// heat of these nodes, equal per mass: eta = D / sum m_k, in what the gather reads of a node
/// (kinematics/mpm/ledger.hpp). For an inelastic stop of two fields D = J/2 times the closing
/// velocity of v-; a lasting joint costs nothing however large J is. Booked push by push instead,
/// with the v+ of the moment, the cross terms of three fields, or of contact and then a wall, would
/// be lost.
#include <array>
#include <vector>

#include "krater/core/reproducible_sum.hpp"

namespace krater {

class ImpulseHeat {
 public:
  void clear() {
    pushed_.clear();
    losses_.clear();
  }
  /// A node of the loss to come: its mass as the points gave it, and the change of its v+.
  void add(double* node, double mass, const std::array<double, 3>& change) {
    pushed_.push_back({node, mass, change});
  }
  /// The nodes since the last call share one loss; W [J] may be added to later, by the index
  /// returned. `counted`: its D belongs to the sum of book() on this rank (grid/blocks.hpp).
  std::size_t close(double outside = 0, bool counted = true) {
    losses_.push_back({pushed_.size(), outside, counted});
    return losses_.size() - 1;
  }
  std::size_t count() const { return losses_.size(); }
  void add_work(std::size_t loss, double work) { losses_[loss].outside += work; }
  /// Adds eta to the nodes, which hold k; returns the sum of D [J].
  ReproducibleSum book() const;

 private:
  struct Pushed {
    double* node;
    double mass;
    std::array<double, 3> change;
  };
  struct Loss {
    std::size_t end;  ///< of its nodes in pushed_
    double outside;   ///< W
    bool counted;
  };
  std::vector<Pushed> pushed_;
  std::vector<Loss> losses_;
};

}  // namespace krater
