// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/materials/scalar_eos.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "krater/core/errors.hpp"
#include "krater/materials/law_list.hpp"

namespace krater {

namespace {

template <class Law>
class Functions final : public ScalarEos {
 public:
  explicit Functions(const Law& law) : law_{law} {
    rho0 = law.rho0;
    c0 = law.c0;
    e0 = energy_at_start(law);
    p0 = pressure_at_start(law);
  }
  double pressure(double rho, double e) const override {
    return pressure_at(at_start(law_), rho, 1.0 / rho, e);
  }
  double bulk_modulus(double rho, double e) const override {
    const double v = 1.0 / rho;
    if constexpr (OwnsState<Law>) {
      return law_.at(at_start(law_).after(rho, v, e)).bulk_modulus(rho, v, pressure(rho, e), e);
    } else {
      return law_.bulk_modulus(rho, v, pressure(rho, e), e);
    }
  }
  bool beyond_pole(double rho) const override {
    if constexpr (requires { at_start(law_).beyond_pole(rho); })
      return at_start(law_).beyond_pole(rho);
    return false;
  }

 private:
  Law law_;
};

using Made = std::unique_ptr<ScalarEos>;

template <class Law>
Made make(const double* values, const MaterialConstants& constants) {
  if constexpr (Law::family == Family::eos) {
    return std::make_unique<Functions<Law>>(make_law<Law>(values, constants));
  } else {
    throw std::logic_error(std::string{Law::name} + " is no equation of state");
  }
}

template <class... Laws>
Made make_indexed(LawList<Laws...>, int law, const double* values,
                  const MaterialConstants& constants) {
  using Maker = Made (*)(const double*, const MaterialConstants&);
  static constexpr Maker makers[] = {&make<Laws>...};
  if (law < 0 || law >= LawList<Laws...>::size) throw std::out_of_range("make_scalar_eos");
  return makers[law](values, constants);
}

ShockState state_at(const ScalarEos& eos, double eta, double e) {
  const double rho = eos.rho0 / (1 - eta), p = eos.pressure(rho, e);
  const double jump = p - eos.p0;
  ShockState s{};
  s.particle_speed = std::sqrt(std::fmax(0.0, jump * eta / eos.rho0));
  s.shock_speed = eta > 0 ? std::sqrt(std::fmax(0.0, jump / (eos.rho0 * eta))) : eos.c0;
  s.pressure = p;
  s.density = rho;
  s.energy = e;
  s.sound_speed = std::sqrt(eos.bulk_modulus(rho, e) / rho);
  return s;
}

/// Where a function of (low, high) changes from negative to positive, to the last bit.
template <class Function>
double bisect(double low, double high, const Function& above) {
  for (int i = 0; i < 200; ++i) {
    const double middle = low + 0.5 * (high - low);
    if (middle <= low || middle >= high) break;
    (above(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

std::unique_ptr<ScalarEos> make_scalar_eos(int law, const double* values,
                                           const MaterialConstants& constants) {
  return make_indexed(AllLaws{}, law, values, constants);
}

ShockState behind_shock(const ScalarEos& eos, double up) {
  if (!(up > 0)) return state_at(eos, 0.0, eos.e0);
  // Energy and momentum leave one unknown, eta = 1 - rho0/rho. The first root from below is that of
  // one shock.
  const auto energy = [&](double eta) { return eos.e0 + 0.5 * up * up + eos.p0 * eta / eos.rho0; };
  const auto above = [&](double eta) {
    return eos.pressure(eos.rho0 / (1 - eta), energy(eta)) - eos.p0 >= eos.rho0 * up * up / eta;
  };
  double low = 0, high = 0.1 * up / (eos.c0 + up);
  while (!above(high)) {
    low = high;
    high += 0.02 * (1 - high) * std::fmin(1.0, 5 * high);
    if (1 - high < 1e-6)
      throw InputError("this equation of state has no state behind a shock of particle speed " +
                       std::to_string(up) + " m/s");
  }
  const double eta = bisect(low, high, above);
  ShockState s = state_at(eos, eta, energy(eta));
  s.particle_speed = up;
  s.shock_speed = up / eta;
  return s;
}

ShockState shocked_to_density(const ScalarEos& eos, double density) {
  const double eta = 1 - eos.rho0 / density;
  const auto fail = [&](const char* why) {
    throw InputError("no shock reaches the density " + std::to_string(density) + " kg/m^3: " + why);
  };
  if (eta < 0) fail("it lies below that at rest");
  if (eta == 0) return state_at(eos, 0.0, eos.e0);
  const double half_dv = 0.5 * eta / eos.rho0;
  const auto above = [&](double e) {
    return e - eos.e0 >= (eos.pressure(density, e) + eos.p0) * half_dv;
  };
  double low = eos.e0, high = eos.e0, step = 1e-6 * eos.c0 * eos.c0;
  do {
    low = high;
    high += step;
    step *= 2;
    if (high - eos.e0 > 1e6 * eos.c0 * eos.c0) fail("one shock cannot compress it so far");
  } while (!above(high));
  return state_at(eos, eta, bisect(low, high, above));
}

}  // namespace krater
