// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/energy_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace krater {

namespace {

/// What took the motion that became heat: of all bodies, as the account does not part them.
std::string cause_of_heat(const Audit& a) {
  const double transfer = a.transfer_loss + a.transfer_gain;
  const double most = std::max({std::abs(transfer), a.contact_heat, a.wall_heat});
  // All that was given: of elastic matter the transfer takes back as heat what it did not lose.
  const double taken = a.transfer_loss + a.contact_heat + a.wall_heat;
  if (taken < 0.5 * std::abs(a.numerical_heat))
    return fmt::format(
        "mostly of the steps in which elastic work is summed (contact, walls and transfer took "
        "{:.4g} J): a smaller time.cfl lowers it",
        taken);
  if (most == a.contact_heat)
    return fmt::format(
        "mostly of contact ({:.4g} J), which stops a layer of cells: a smaller grid.cell lowers it",
        a.contact_heat);
  if (most == a.wall_heat)
    return fmt::format(
        "mostly of walls ({:.4g} J), which stop a layer of cells: a smaller grid.cell lowers it",
        a.wall_heat);
  return fmt::format(
      "mostly of the transfer between points and grid ({:+.4g} J): a smaller grid.cell lowers it, "
      "and method.transfer: tflip where it is another",
      transfer);
}

struct Part {
  const char* name;
  std::string meaning;  ///< and what lowers it
};

/// In the order of Audit::unphysical().
std::array<Part, 4> parts(const Audit& a) {
  return {
      {{"energy_residual", "energy that is missing or came from nowhere: please report this scene"},
       {"numerical_heat",
        "dissipation that a material whose pressure does not know its energy cannot feel, " +
            cause_of_heat(a) +
            "; an equation of state whose pressure knows it (gamma0 > 0) makes it heat"},
       {"carried_energy",
        "heat that matter was too cold to give: a viscosity block, a smaller time.cfl, or "
        "method.transfer: tflip lowers it"},
       {"rigid_loss",
        "of rigid bodies by the steps of their turn: a smaller time.max_step lowers it"}}};
}

}  // namespace

std::string describe_energy_error(const Audit& audit, double allowed) {
  const std::array<double, 4> values = audit.unphysical();
  const auto most = std::max_element(values.begin(), values.end(),
                                     [](double x, double y) { return std::abs(x) < std::abs(y); });
  const Part part = parts(audit)[static_cast<std::size_t>(most - values.begin())];
  return fmt::format(
      "energy error {:.2f} % of the {:.4g} J in the scene (energy_error_fraction; {:g} % allowed): "
      "most of it {} ({:+.4g} J), {}",
      100 * audit.error_fraction(), audit.peak_energy, 100 * allowed, part.name, *most,
      part.meaning);
}

}  // namespace krater
