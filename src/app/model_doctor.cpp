// SPDX-License-Identifier: GPL-3.0-or-later
// Traps of concrete and ceramic cards.
#include <cmath>

#include <fmt/format.h>

#include "krater/app/card_doctor.hpp"

namespace krater {

namespace {

double value(const MaterialOptions& m, const char* key) {
  return parameter(m.model, key).value_or(0);
}

void check_concrete(const MaterialOptions& m, std::vector<std::string>& doubts) {
  const double K1 = value(m, "K1"), K2 = value(m, "K2"), K3 = value(m, "K3");
  const double p_lock = value(m, "lock_pressure");
  double x = p_lock / K1;
  for (int i = 0; i < 50; ++i)
    x -= (x * (K1 + x * (K2 + x * K3)) - p_lock) / (K1 + x * (2 * K2 + x * 3 * K3));
  const double slope = K1 + x * (2 * K2 + x * 3 * K3);
  if (value(m, "unloading") > 0.5 && K1 < slope)
    doubts.push_back(fmt::format(
        "unloading: published is shallower (K1 = {:.4g} GPa) than the loading curve of the grains "
        "({:.4g} GPa): closed cycles make energy; use unloading: consistent",
        1e-9 * K1, 1e-9 * slope));
  const double T = value(m, "tensile_strength"), f = value(m, "compressive_strength");
  constexpr double largest_share = 0.2;  // of concretes the mean tension is 0.05 to 0.12 of f
  if (f > 0 && T > largest_share * f)
    doubts.push_back(
        fmt::format("tensile_strength {:.4g} MPa is {:.2f} of compressive_strength; "
                    "concrete bears about a tenth",
                    1e-6 * T, T / f));
}

/// HEL against P_HEL and the elastic constants, and the strength at the HEL against its unit.
void check_ceramic(const MaterialOptions& m, std::vector<std::string>& doubts) {
  const double K1 = value(m, "K1"), K2 = value(m, "K2"), K3 = value(m, "K3");
  const double HEL = value(m, "HEL"), P = value(m, "P_HEL"), G = m.shear_modulus;
  double mu = P / K1;
  for (int i = 0; i < 50; ++i)
    mu -= (mu * (K1 + mu * (K2 + mu * K3)) - P) / (K1 + mu * (2 * K2 + mu * 3 * K3));
  const double implied = P + 4.0 / 3.0 * G * mu / (1 + mu);
  constexpr double tolerance = 0.05;
  if (std::fabs(implied / HEL - 1) > tolerance)
    doubts.push_back(
        fmt::format("P_HEL and the elastic constants give HEL = {:.4g} GPa, the card "
                    "says {:.4g} GPa ({:+.1f} %)",
                    1e-9 * implied, 1e-9 * HEL, 100 * (implied / HEL - 1)));
  const double unit = value(m, "A") * std::pow(1 + value(m, "tensile_strength") / P, value(m, "N"));
  constexpr double widest = 0.2;  // the rate factor at the HEL closes up to this (about 1e5 /s)
  if (std::fabs(unit - 1) > widest)
    doubts.push_back(
        fmt::format("the intact strength at P_HEL is {:.3g} of that at the HEL; it "
                    "should be about 1 (A, N, T)",
                    unit));
}

}  // namespace

void check_model(const MaterialOptions& m, std::vector<std::string>& doubts) {
  if (!m.model) return;
  if (m.model->name == "holmquist_johnson_cook" || m.model->name == "osborn")
    check_concrete(m, doubts);
  if (m.model->name == "johnson_holmquist_2") check_ceramic(m, doubts);
}

}  // namespace krater
