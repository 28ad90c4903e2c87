// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Bodies of elements inside a test: material, sides and end from a scene's YAML text (its body has
// no say but by its velocity), the mesh given by hand.
#include <memory>
#include <string>
#include <vector>

#include "krater/kinematics/clock.hpp"
#include "krater/kinematics/mesh/mesh_step.hpp"
#include "krater/materials/assembly.hpp"
#include "krater/scene/scene.hpp"
#include "verification/run_support.hpp"

namespace krater::test {

/// One body of the scene's first material.
class MeshRun {
 public:
  MeshRun(const std::string& yaml, const Mesh& mesh, const Overrides& overrides = {},
          const HourglassOptions& held = {}, double cfl = 0.9,
          ElementReference reference = ElementReference::current, double refresh_strain = 0.3);

  void step(double until);
  void run_to(double time);
  double time() const { return clock_.time(); }
  double dt() const { return clock_.dt(); }
  std::int64_t steps() const { return clock_.steps(); }
  bool done() const { return time() >= scene_->time.end; }
  MeshStep& mesh() { return *step_; }
  const Audit& audit() const { return audit_; }
  const Scene& scene() const { return *scene_; }
  /// Kinetic + internal + hourglass energy less that of the start [J].
  double energy_change() const {
    return audit_.kinetic + audit_.internal - audit_.initial_kinetic - audit_.initial_internal;
  }
  /// One component of a field of all elements.
  std::vector<double> column(const FieldInfo& field, int component = 0) const;
  void set_column(const FieldInfo& field, int component, const std::vector<double>& values);

 private:
  std::unique_ptr<const Scene> scene_;
  Layout layout_;
  std::vector<NamedStage> stages_;
  std::vector<const Stage*> pointers_;
  std::unique_ptr<MeshKernels> kernels_;
  Audit audit_;
  std::unique_ptr<MeshStep> step_;
  StepClock clock_;
};

/// Scene of an elastic body of unit density and modulus that moves at `velocity`.
std::string text_of(const std::string& frame, const std::string& velocity,
                    const std::string& more = "");
/// Every node moved by up to `amplitude` along each axis.
Mesh shaken(Mesh mesh, double amplitude, unsigned seed);
/// Of all nodes; forces are found anew.
void set_velocities(MeshRun& run, const std::vector<Triple>& v);

}  // namespace krater::test
