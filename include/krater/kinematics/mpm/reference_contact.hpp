// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mpm/reference_contact.hpp
/// Contact of bodies whose weights live on a fixed reference (theory 3, the last term of CCF
/// Theorem 1). Each body has a reference grid of its own, and no node of it is where another body
/// is. So they meet on a grid in the current configuration, with shape functions S: the points near
/// another body carry there what the reference nodes move them with,
///   p_i = sum_p S_i m_p [v_p + L_p (x_i - x_p)] = m_i sum_I A_iI v_I,
///   v_p = sum_I N_I(X_p) v_I,  L_p = sum_I v_I (x) grad N_I F^-1,
/// impulses are those of contact/contact.hpp, and they come back by the adjoint:
///   m_I dv_I = sum_i A_iI m_i dv_i
///            = sum_p m_p [N_I sum_i S_i dv_i + (sum_i S_i dv_i (x) (x_i - x_p)) F^-T grad N_I].
/// As sum_I A_iI = 1 momentum is exact. The terms with L make of A about N_I at the place of node
/// i: weights by N and S alone would smooth twice, and what they smooth away would never be
/// stopped. A node gives back less than the impulse asked of it, so fill, push and return are
/// repeated (kPasses), geometry fixed.
/// What a push takes from motion belongs to its node i of the current grid,
///   D_i = - sum_bodies (sum over passes of m_i dv_i) . (A vbar)_i,
/// for sum_i D_i is what the reference nodes lose, with their final vbar; it is heat of the points
/// around i, handed back by N S.
/// Points within two blocks of another body's take part; others are not touched.
#include <array>
#include <utility>
#include <vector>

#include "krater/contact/contact.hpp"
#include "krater/kinematics/mpm/kernels.hpp"

namespace krater {

class ReferenceContact {
 public:
  /// All references must outlive it. `kernels`: of the current configuration, B-splines, affine.
  /// `shape`: N of the reference.
  struct Parts {
    BlockGrid& grid;
    const BoundarySet& boundary;
    ContactSet& contact;
    const Kernels& kernels;
    const std::vector<BodyKernelData>& bodies;
    KernelShape shape;
  };
  explicit ReferenceContact(const Parts& parts);

  /// Change v+ and dv of the reference nodes; after the momentum update.
  ContactWork apply();
  /// Heat of the impulses to the reference nodes, which hold k; returns it [J]. When every v+ is
  /// final.
  double heat();
  /// Rate of the fastest point near another body [1/s]: bodies must see each other in time.
  double travel_rate() const { return travel_rate_; }

 private:
  struct Carrier {
    int patch, point;  ///< on the reference grid
  };
  struct Entry {
    BlockKey key;  ///< of the current configuration
    int body;
    bool operator==(const Entry&) const = default;
  };
  struct Reach {
    std::array<int, 3> first{};  ///< storage index
    double w[3][3], d[3][3];     ///< [axis][node]; d per metre
  };
  /// What a carrier hands back: sum_i S_i dv_i, its first moment, and heat per mass.
  struct Share {
    double velocity[3]{}, moment[3][3]{}, heat = 0;
  };

  static bool earlier(const Entry& a, const Entry& b);
  std::vector<Entry> blocks_of_points() const;
  std::vector<Entry> near_each_other() const;
  bool collect();
  void append(Patch& to, const Patch& from, const PointColumns& columns, int point);
  void project(double share_of_change);
  Reach reach(const PointStore& points, int position, int half_width, int i,
              KernelShape shape) const;
  int node_of(const Patch& patch, const std::array<int, 3>& storage) const;
  /// call(storage index, weight, slopes) of the nodes that a point sees.
  template <class Call>
  void for_nodes(const Reach& reach, const Call& call) const;
  void inverse_map(const Patch& patch, const PointColumns& c, int i, double (&out)[3][3]) const;
  Share share_of(const Patch& patch, int i, bool heat) const;
  void hand_back(bool heat);
  void add(const Carrier& carrier, double mass, const Share& share);
  void add_folded(std::array<int, 3> storage, int body, std::array<double, 4> value);
  void note_impulses();
  double push_nodes();
  void warm_nodes();

  BlockGrid& grid_;
  const BoundarySet& boundary_;
  ContactSet& contact_;
  const Kernels& kernels_;
  const std::vector<BodyKernelData>& bodies_;
  KernelShape shape_;
  BlockGrid current_;
  BoundarySet sides_;
  RigidBodies none_;
  Layout layout_;
  BodyKernelData carrier_data_;
  std::vector<PointColumns> carrier_columns_;  ///< the same for every body
  std::vector<Entry> near_;
  std::vector<std::vector<Carrier>> carriers_;   ///< by patch of current_
  std::vector<std::array<double, 3>> impulses_;  ///< by node of current_, over the passes
  std::vector<char> pushed_;                     ///< by block of current_
  std::vector<std::array<double, 4>> given_;     ///< by reference node: momentum, heat
  std::vector<int> touched_;
  std::vector<double> record_;
  AlignedBuffer zeros_;
  struct Memory {
    AlignedBuffer cells, pressures, halo;
  };
  std::vector<Memory> memory_;
  double travel_rate_ = 0;
};

template <class Call>
void ReferenceContact::for_nodes(const Reach& r, const Call& call) const {
  const int dimension = grid_.geometry().dimension;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < (dimension == 3 ? 3 : 1); ++k) {
        const double wk = dimension == 3 ? r.w[2][k] : 1, wij = r.w[0][i] * r.w[1][j];
        const double slope[3] = {r.d[0][i] * r.w[1][j] * wk, r.w[0][i] * r.d[1][j] * wk,
                                 dimension == 3 ? wij * r.d[2][k] : 0};
        call(std::array<int, 3>{r.first[0] + i, r.first[1] + j, r.first[2] + k}, wij * wk, slope);
      }
}

}  // namespace krater
