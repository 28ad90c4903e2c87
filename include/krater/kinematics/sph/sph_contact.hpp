// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sph/sph_contact.hpp
/// Contact of bodies of particles, with each other, with bodies of material points, rigid bodies
/// and bodies of elements. A body of particles has a surface that is known no better than that of
/// material points, so it meets others as these do (contact/contact.hpp): at the nodes i of the
/// grid, with the quadratic B-spline S, where it shows
///   m_i = sum_p S_ip m_p,   p_i = sum_p S_ip m_p (v_p + dv_p),   V_i = sum_p S_ip m_p/rho_p,
/// is told from its partner by fillings, and what is pushed comes back by the adjoint,
///   dv_p = sum_i S_ip dv_i,   sum_p m_p dv_p = sum_i m_i dv_i:
/// momentum is exact, and kinetic energy is never given. What a node asks is smoothed on the way
/// back, so the exchange is repeated (kPasses). Nodes of bodies of points are those of their own
/// grid, pushed as they are. What is lost of motion is heat of what was pushed, by m |dv|^2.
/// Particles further than kReach cells from the box of any other body do not take part, nor those
/// outside the domain. A body does not meet itself.
/// In parallel over particles and over blocks of nodes: a block sums what reaches it in the order
/// of the particles, so bits do not depend on threads.
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "krater/contact/contact.hpp"
#include "krater/contact/impulses.hpp"
#include "krater/core/parallel.hpp"
#include "krater/kinematics/encounter.hpp"
#include "krater/kinematics/sph/sph_step.hpp"

namespace krater {

class SphContact final : public Encounter {
 public:
  /// What must outlive it. `grid` holds the velocity fields of all bodies of points, each its own.
  struct Parts {
    SphStep& particles;
    BlockGrid& grid;
    const BoundarySet& boundary;
    RigidBodies& rigid;
    Audit& audit;
    Impulses& impulses;
  };
  /// `fluids`: by body of the scene, as of ContactSet.
  SphContact(const ContactOptions& options, std::vector<bool> fluids, const Parts& parts);
  ~SphContact() override;

  /// Bodies of elements meet at the nodes here (`nodes()`, `fillings()`), in turn with particles.
  void set_meshes(std::unique_ptr<PassingEncounter> meshes) { meshes_ = std::move(meshes); }
  BlockGrid& nodes() { return nodes_; }
  const ContactSet& fillings() const { return contact_; }

  void push(double dt) override;
  Standing book() override;

 private:
  struct Carrier {
    int set, particle;
    BlockKey key;
    int patch;                 ///< of nodes_
    std::array<int, 3> first;  ///< storage index of the first node
    double weight[3][3];       ///< [axis][node]
    double mass, volume;
    Triple momentum;
    Triple by_contact;  ///< dv
    EncounterLoss loss;
  };
  /// A body at a block of nodes.
  struct Entry {
    BlockKey key;
    int body;
    friend bool operator==(const Entry&, const Entry&) = default;
  };
  /// A block of a body of points: here, and on its own grid.
  struct Shared {
    std::size_t here, there;
    std::array<Triple, kBlockNodes> impulse;  ///< in the step [N s]
    std::array<double, kBlockNodes> mass;     ///< pushed: before walls join nodes
  };

  static bool earlier(const Entry& a, const Entry& b);
  SpaceBox box_of_set(int set) const;
  std::vector<SpaceBox> boxes() const;
  SpaceBox box_of(const BlockKey& key) const;
  bool takes_part(const Triple& x, const std::vector<SpaceBox>& others) const;
  Carrier carrier_of(int set, int particle) const;
  void add_carriers(int set, const std::vector<SpaceBox>& others, std::vector<Entry>& blocks);
  bool find_carriers();
  void lay_out(std::vector<Entry> entries);
  void list_reaching();
  void share_blocks();
  void add_to(const NodeBlock& block, const Carrier& carrier) const;
  void fill();
  void show_points();
  void give_back();
  void take_pushes();
  EncounterLoss loss();
  void book_rigid(const ContactWork& work, double kinetic);
  template <class Visit>
  void for_nodes(const Carrier& carrier, const Visit& visit) const;
  /// visit(carrier) on any thread: it may change that carrier and its particle.
  template <class Visit>
  void for_carriers(const Visit& visit) {
    constexpr std::size_t kChunk = 64;
    for_each((carriers_.size() + kChunk - 1) / kChunk, [&](std::size_t c) {
      for (std::size_t k = kChunk * c; k < carriers_.size() && k < kChunk * (c + 1); ++k)
        visit(carriers_[k]);
    });
  }

  static constexpr std::size_t kNone = ~std::size_t{0};
  int dim_, edge_;
  std::array<int, 3> stride_;  ///< of nodes in a block
  GridGeometry geometry_;
  Parts parts_;
  std::vector<std::size_t> set_of_body_;  ///< of particles; kNone
  BlockGrid nodes_;
  BoundarySet sides_;
  ContactSet contact_;
  std::unique_ptr<PassingEncounter> meshes_;
  // Of the step:
  std::vector<Entry> entries_;
  std::vector<Carrier> carriers_;
  std::vector<std::uint32_t> first_reaching_, reaching_;  ///< carriers, by block of nodes
  std::vector<Shared> shared_;
  Triple given_{};  ///< to particles, at nodes [N s]
  double friction_ = 0, pairs_ = 0, rigid_work_ = 0;
  bool any_ = false;
};

}  // namespace krater
