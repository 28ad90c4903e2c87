// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/mesh/mesh_step.hpp
/// Bodies of fixed-mesh Lagrangian elements (kinematics/mesh/element.hpp, mesh_sweeps.hpp):
///   m_I = sum_e m_eI,   dv_I = dt f_I/m_I,   x_I <- x_I + dt v_I+,
/// sums in order of elements. Sides of the domain act on the nodes themselves: a plane of symmetry
/// and the axis hold the normal velocity of the nodes that lie on it at the start; a wall lets no
/// node pass, x + dt v+ on its plane, with Coulomb friction, and never pulls; sticky holds a node
/// whole from when it touches. What that takes from the motion of a node is heat of its elements.
/// Kinetic + internal + hourglass energy is constant to round-off.
/// Bodies meet each other and those of points by their faces (kinematics/mesh/mesh_contact.hpp).
/// Loads on their faces and masses: kinematics/mesh/mesh_loads.hpp.
#include <array>
#include <memory>
#include <vector>

#include "krater/contact/impulses.hpp"
#include "krater/contact/options.hpp"
#include "krater/core/aligned.hpp"
#include "krater/geometry/frame.hpp"
#include "krater/kinematics/audit.hpp"
#include "krater/kinematics/kinematics.hpp"
#include "krater/kinematics/mesh/conversion.hpp"
#include "krater/kinematics/mesh/erosion.hpp"
#include "krater/kinematics/mesh/mesh.hpp"
#include "krater/kinematics/mesh/mesh_health.hpp"
#include "krater/kinematics/mesh/mesh_kernels.hpp"
#include "krater/kinematics/sides.hpp"

namespace krater {

/// What a body of elements is made of; pointers must outlive the step.
struct ElementBody {
  int body = 0;
  Mesh mesh;
  std::vector<Triple> velocities;  ///< of its nodes [m/s]
  const Layout* layout = nullptr;
  const Stage* const* stages = nullptr;
  int stage_count = 0;
  double density = 0, shear_modulus = 0;
  double q_lin = 0, q_quad = 0;
  bool barotropic = false;  ///< its pressure does not know its energy
  HourglassOptions held;
  ElementReference reference = ElementReference::current;
  double refresh_strain = 0.3;
  ErosionOptions erosion;
  std::optional<PointsOfElements> points;  ///< what its elements become; none: they are eroded
};

/// The columns that elements need beside those of their material: before and after its stages are
/// made.
void declare_elements(double density, Layout& layout);
void declare_element_results(Layout& layout);

/// Sums over the nodes of a body.
struct NodeTotals {
  double mass = 0, kinetic = 0;
  Triple momentum{};
  double angular_momentum = 0;  ///< about the origin, of the first two axes
};

/// The nodes of a body, as a step holds them.
struct MeshNodes {
  int body;         ///< in the scene
  double* records;  ///< 8 per node: x, m, v, heat per mass of the step
  double* changes;  ///< 4 per node: dv of the step so far
  std::size_t count;
};

class MeshLoads;

/// Thrown by move(): element `element` of set `set`.
struct ElementFault {
  int set;
  Fault fault;
};

class MeshStep final : public Kinematics {
 public:
  MeshStep(const DomainSides& domain, const MeshKernels& kernels, Audit& audit);
  ~MeshStep() override;

  /// Who is told what sides give bodies; `apart`: bodies are velocity fields of their own.
  void set_impulses(Impulses& impulses, bool apart);
  /// What pushes from outside; before the first step, and at each one when it is.
  void set_loads(std::unique_ptr<MeshLoads> loads);
  void set_time(double time);
  /// Load `load` acts on some face.
  bool feels(std::size_t load) const;
  /// Throws InputError where an element has no volume or a node no element.
  void add(ElementBody body);
  void start();  ///< after the last body: forces, energies, and the first limit of the step

  double force(double dt) override;
  void meet(double dt) override;
  Standing move(double dt, const Standing& others) override;
  const TimeStepLimit& limit() const override { return limit_; }
  int set_count() const override { return static_cast<int>(bodies_.size()); }
  PointSet set(int s) const override;
  /// find_forces() afterwards.
  PointStore& change(int s) override;
  void find_forces();

  const std::vector<std::array<std::int32_t, 2>>& surface(int s) const;  ///< edges, by nodes
  std::vector<MeshNodes> nodes();  ///< of all bodies, in the order of the sets
  /// Planes of symmetry hold their nodes against the forces so far; meet() does it for the rest.
  void hold_nodes();
  /// Faces that others may touch (exposed_faces()): not those that lie on a plane of symmetry. A
  /// node without elements is one of one corner.
  std::vector<std::array<std::int32_t, 4>> meeting_faces(int s) const;
  std::size_t shape_changes() const { return shape_changes_; }  ///< how often elements were taken
  Eroded eroded() const;                                        ///< since the start, by cause
  Eroded converted() const;  ///< elements that became points, likewise
  /// The points that elements became in the last step, for whoever moves points.
  std::vector<ConvertedPoints> take_converted();
  NodeTotals totals(int s) const;
  double internal_energy(int s) const;  ///< hourglass energy included [J]
  /// Nodes, and what elements hold beside their columns; find_forces() after it was put back.
  std::vector<double> state(int s) const;
  bool set_state(int s, const std::vector<double>& state);  ///< false: of another length
  /// Before columns are put back: a body that has eroded has fewer. False: it has not as many.
  bool set_count(int s, std::size_t elements);
  void pad(int s);                  ///< after columns were changed from outside
  std::size_t memory() const;       ///< of nodes and elements [bytes]
  double hourglass_energy() const;  ///< part of the internal energy [J]
  MeshHealth health() const;
  MeshOverlap overlap(double cell) const;  ///< of each body with itself
  struct Elements;                         ///< of one body
  const Mesh& mesh(int s) const;  ///< nodes as they were at the start; elements in their order
  std::size_t node_count(int s) const;
  Triple position(int s, std::size_t node) const;
  Triple velocity(int s, std::size_t node) const;
  double mass(int s, std::size_t node) const;
  Triple force_of(int s, std::size_t node) const;  ///< of the elements, as last found [N]

 private:
  struct WallSums {
    double heat = 0, work = 0;        ///< work: of sides that move, from outside [J]
    std::array<Triple, 6> by_side{};  ///< on the body, of each side that pushes [N s]
    Triple impulse{};
  };
  struct Chunk {
    std::size_t body;
    int first, last;
  };
  ElementScratch scratch();
  ElementData data(Elements& body);
  void hold_planes(Elements& body, std::size_t first, std::size_t last, WallSums& sums) const;
  void push_from_sides(Elements& body, std::size_t first, std::size_t last, double dt,
                       WallSums& sums) const;
  void note_planes(Elements& body) const;
  void make_chunks();
  bool erode();  ///< true: something was
  Eroded taken_out(bool converted) const;
  void lose_heat(const Elements& body);
  template <class Work>
  void over_nodes(const Work& work);
  void note_sides(const Elements& body, const WallSums& sums);
  void find_limit(const std::vector<ElementResult>& results);
  void book(const std::vector<ElementResult>& results, const Standing& others);

  DomainSides domain_;
  int dim_;
  std::vector<PushingSide> pushing_;
  const MeshKernels& kernels_;
  Audit& audit_;
  std::vector<std::unique_ptr<Elements>> bodies_;
  std::vector<Chunk> chunks_;
  Impulses* impulses_ = nullptr;
  std::unique_ptr<MeshLoads> loads_;
  bool apart_ = false;
  std::size_t shape_changes_ = 0;
  std::vector<AlignedBuffer> scratch_;
  TimeStepLimit limit_;
};

}  // namespace krater
