// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sph/sph_step.hpp
/// Bodies of smoothed particles (kinematics/sph/sph_sweeps.hpp, correction.hpp), in three
/// dimensions and plane strain:
///   dv_i = dt f_i/m_i,   x_i <- x_i + dt v_i+,
/// sums in the order of lists (neighbours.hpp). A plane of symmetry is a mirror: beyond it lie the
/// images of particles, and what they do to the body is booked as the side's impulse. Walls act on
/// the particles (kinematics/sides.hpp), half a spacing from the plane, for a particle is as wide;
/// what started nearer stays as near. What a side takes from the motion of a particle is its heat.
/// Kinetic + internal energy is constant to round-off. Loads: kinematics/sph/sph_loads.hpp.
/// Not here: axial symmetry (issue 28).
#include <memory>
#include <vector>

#include "krater/core/aligned.hpp"
#include "krater/kinematics/audit.hpp"
#include "krater/kinematics/kinematics.hpp"
#include "krater/kinematics/sides.hpp"
#include "krater/kinematics/sph/options.hpp"
#include "krater/kinematics/sph/sph_kernels.hpp"

namespace krater {

/// What a body of particles is made of; pointers must outlive the step.
struct SphBody {
  int body = 0;
  PointStore points;  ///< records of all particles, in any order
  const Layout* layout = nullptr;
  const Stage* const* stages = nullptr;
  int stage_count = 0;
  double density = 0, shear_modulus = 0;
  double q_lin = 0, q_quad = 0;
  bool barotropic = false;  ///< its pressure does not know its energy
  SphOptions options;
};

/// The columns that particles need beside those of their material: before and after its stages are
/// made.
void declare_particles(double density, bool face_loads, Layout& layout);
void declare_particle_results(Layout& layout);

/// What particles say of themselves.
struct SphHealth {
  std::size_t particles = 0, images = 0;
  std::size_t flat = 0;    ///< whose gradients are not corrected in full
  double neighbours = 0;   ///< listed, in the mean
  std::int64_t lists = 0;  ///< made so far
};

/// Thrown by move(): particle of set `set`.
struct ParticleFault {
  int set;
  Fault fault;
};

class SphLoads;

class SphStep final : public Kinematics {
 public:
  /// Throws std::invalid_argument in axial symmetry.
  SphStep(const DomainSides& domain, IsaLevel level, Audit& audit);
  ~SphStep() override;

  /// What pushes from outside; before the first step, and at each one when it is.
  void set_loads(std::unique_ptr<SphLoads> loads);
  void set_time(double time);
  void add(SphBody body);
  void start();  ///< after the last body: lists, forces, energies, and the first limit of the step

  double force(double dt) override;
  void meet(double dt) override;
  Standing move(double dt, const Standing& others) override;
  const TimeStepLimit& limit() const override { return limit_; }
  int set_count() const override { return static_cast<int>(bodies_.size()); }
  PointSet set(int s) const override;
  /// find_forces() afterwards.
  PointStore& change(int s) override;
  void find_forces();

  double kinetic_energy(int s) const;   ///< [J]
  double internal_energy(int s) const;  ///< [J]
  /// Of the stresses, as last found, on particle i of a set [N].
  Triple force_of(int s, int i) const;
  double power_of(int s, int i) const;  ///< of the stresses in particle i, V sigma : L [W]
  /// What particles hold beside their columns; find_forces() after it was put back.
  std::vector<double> state(int s) const;
  bool set_state(int s, const std::vector<double>& state);  ///< false: of another length
  void pad(int s);             ///< after columns were changed from outside
  std::size_t memory() const;  ///< [bytes]
  SphHealth health() const;
  std::size_t flat_count() const;  ///< as in health(), which looks at all lists
  struct Particles;                ///< of one body
  Particles& particles(int s) { return *bodies_[static_cast<std::size_t>(s)]; }

 private:
  struct SideSums {
    double heat = 0, work = 0;  ///< work: of sides that move, from outside [J]
    Triple impulse{};
  };
  struct Chunk {
    std::size_t body;
    int first, last;
  };
  /// A plane of symmetry across the axis.
  bool mirrored(std::size_t axis) const {
    return domain_.sides[axis][0].kind == BoundaryKind::symmetry ||
           domain_.sides[axis][1].kind == BoundaryKind::symmetry;
  }
  SphData data(Particles& body) const;
  SphScratch scratch();
  /// work(body, its data, first group, last group, number of the chunk).
  template <class Work>
  void over_groups(const Work& work);
  void renew_lists();
  void renew_references(const std::vector<SphResult>& results);
  void find_areas();
  void book_loads();
  void push_from_sides(Particles& body, int first, int last, double dt, SideSums& sums) const;
  void find_limit(const std::vector<SphResult>& results);
  void book(const std::vector<SphResult>& results, const Standing& others);

  DomainSides domain_;
  int dim_;
  IsaLevel level_;
  std::vector<PushingSide> pushing_;
  Audit& audit_;
  std::vector<std::unique_ptr<Particles>> bodies_;
  std::vector<Chunk> chunks_;
  std::vector<AlignedBuffer> scratch_;
  std::unique_ptr<SphLoads> loads_;
  TimeStepLimit limit_;
};

}  // namespace krater
