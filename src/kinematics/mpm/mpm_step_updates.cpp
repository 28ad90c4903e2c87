// SPDX-License-Identifier: GPL-3.0-or-later
// The second passes of musl and usf.
#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

// The new velocities, and L of the same v+, with the old weights. L of this projection would not
// do: next to the residual that TFLIP keeps it would feed on itself.
void MpmStep::project_again(double dt) {
  particles_to_grid(kernels_, bodies_, dt);
  momentum(dt, 0);
  constrain(true);
}

// Stress first: the strain of the motion that the last step made, seen where it ended,
// f = (I - dt L)^-1 with L of the velocities the points arrived with. Taken forwards instead, with
// the map I + dt L of a motion still to come, a body that turns by w dt swells by 2 (w dt)^2 a
// step.
void MpmStep::strain_last_motion() {
  double dt = last_step_;
  last_step_ = 0;  // once, however often force() is asked
  particles_to_grid(kernels_, bodies_, dt);
  double kinetic = momentum(dt, 0);
  begin_rigid(dt, kinetic);
  constrain(true);
  grid_to_particles(GatherPart::strain_only, dt);
  audit_.step_external = 0;
  external_impulse_ = {};
  rigid_.rewind();
}

}  // namespace krater
