// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file contact/impulses.hpp
/// What partners in contact gave each other so far [N s]: body and body, body and side of the
/// domain.
///   J(a, b) = sum over steps and nodes of m_a dv_a,   J(b, a) = -J(a, b),
/// dv_a what the push between the two alone, friction included, changes of the velocity of a at a
/// node. Every transfer gives the points of a all of it, sum_p m_p S_i(x_p) dv = m_a dv, so the
/// momentum of a changes by its J, loads and planes of symmetry to round-off, and dJ/dt is the
/// force. Of a side that pushes also what putting points back in the domain gave them. Only pairs
/// that are watched are kept, and without any nothing is done.
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "krater/contact/options.hpp"
#include "krater/core/reproducible_sum.hpp"
#include "krater/grid/blocks.hpp"

namespace krater {

/// What a velocity field got from its partner.
struct ImpulsePair {
  FieldId on{};
  Partner by;
  Triple impulse{};  ///< [N s]
};

/// The same of one step, in sums that do not depend on the order of their terms.
struct ImpulseSum {
  FieldId on{};
  Partner by;
  std::array<ReproducibleSum, 3> impulse{};  ///< [N s]
};
/// Adds to the pair's entry of a list.
void add_impulse(std::vector<ImpulseSum>& list, FieldId on, Partner by, const Triple& impulse);
void add_impulses(std::vector<ImpulseSum>& list, const std::vector<ImpulseSum>& more);

class Impulses {
 public:
  void watch(FieldId on, Partner by);
  bool any() const { return !pairs_.empty(); }
  /// Of the pair either way round; others are passed over. Collective (core/ranks.hpp): each rank
  /// gives what it counts.
  void add(const std::vector<ImpulseSum>& given, double share = 1);
  /// Of a pair, what all ranks know.
  void book(FieldId on, Partner by, const Triple& impulse);
  /// On the field, of a pair that is watched [N s].
  Triple of(FieldId on, Partner by) const;

  /// In the order in which pairs were watched.
  std::vector<ImpulsePair>& pairs() { return pairs_; }
  const std::vector<ImpulsePair>& pairs() const { return pairs_; }

 private:
  /// Index of a pair and the sign of its impulse on `on`; sign 0: not watched.
  std::pair<std::size_t, double> find(FieldId on, Partner by) const;
  std::vector<ImpulsePair> pairs_;
};

}  // namespace krater
