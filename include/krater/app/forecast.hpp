// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file app/forecast.hpp
/// What a scene costs, from its volumes, cell and times, before any point is made.
///
///     points  = section / h^d * points per cell
///     memory  = points * (columns of the state, and copies of them while frames are written)
///     steps   = end / dt, dt = cfl h / max(2 v, 1.35 c), more where output times cut them
///
/// c: sound speed at rest, 1.35: viscosity and a shock of moderate strength. Rates are those of a
/// 2020s server core: times are good to a factor of about two.
#include <string>
#include <vector>

#include "krater/scene/scene.hpp"

namespace krater {

struct Forecast {
  double points = 0;
  double memory = 0;                ///< greatest, while the run begins or writes [B]
  double results = 0;               ///< files of the results folder [B]
  double steps = 0, cut_steps = 0;  ///< cut_steps: of them because output times cut them
  double frames = 0;
  double setup = 0, stepping = 0, writing = 0;  ///< on one core [s]

  double seconds() const { return setup + stepping + writing; }
};

Forecast forecast(const Scene& scene);

/// Initial (or prescribed) velocities of a body on a few places of its box.
std::vector<Triple> sampled_velocities(const Scene& scene, const BodyOptions& body);

/// The greatest of them [m/s].
double greatest_speed(const Scene& scene, const BodyOptions& body);

/// Throws InputError, with figures and remedy, where the scene needs more memory than there is or
/// more steps than anybody waits for.
void require_feasible(const Scene& scene, const Forecast& forecast);

/// Memory that this process can still get [B]: the least of what the machine has free, the limits
/// of the process and of its control group. `limit` says which.
struct Memory {
  double available = 0;
  std::string limit;
};
Memory memory();

std::string duration_text(double seconds);  ///< "0.4 s", "12 min", "723 days"
std::string bytes_text(double bytes);       ///< "136 MB", "95 GB"
std::string count_text(double count);       ///< "324", "1.2 million"

}  // namespace krater
