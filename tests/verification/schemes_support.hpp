// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// An elastic block in every frame, under every scheme, in random states.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>
#include <sstream>

#include "verification/run_support.hpp"

namespace krater::test {

inline constexpr double kDensity = 1000, kBulk = 1e9, kShear = 5e8;
inline const double kWaveSpeed = std::sqrt((kBulk + 4.0 / 3.0 * kShear) / kDensity);

inline const std::string kFrames[] = {"axisymmetric", "plane_strain", "3d"};
inline const std::string kShapes[] = {"quadratic_bspline", "gimp", "linear"};
inline const std::string kTransfers[] = {"tflip", "flip", "apic", "xpic"};
inline const std::string kUpdates[] = {"usl", "musl", "usf"};

inline bool is_3d(const std::string& frame) { return frame == "3d"; }

/// An elastic block of cells of 1 m in [0, size] of a domain [0, domain]; in 3d y is as x. All
/// sides get `side` (the axis where the frame has one).
inline std::string block_scene(const std::string& frame, double size, double domain,
                               const std::string& side, double low = 0) {
  std::ostringstream yaml;
  yaml.precision(17);
  const auto corner = [&](double x) {
    std::ostringstream text;
    text << "[" << x << ", " << x << (is_3d(frame) ? ", " + std::to_string(x) : "") << "]";
    return text.str();
  };
  const bool axis = frame == "axisymmetric";
  yaml << "frame: " << frame << "\ngrid:\n  cell: 1\n  box: {min: " << corner(0)
       << ", max: " << corner(domain) << "}\n  boundary: {"
       << (axis ? "r_min: axis, r_max: " : "x_min: " + side + ", x_max: ") << side
       << (is_3d(frame) ? ", y_min: " + side + ", y_max: " + side : "") << ", z_min: " << side
       << ", z_max: " << side << "}\ntime: {end: 1}\nmaterials:\n  m:\n    density: " << kDensity
       << "\n    bulk_modulus: " << kBulk << "\n    shear_modulus: " << kShear
       << "\n    eos: linear\n    strength: elastic\n    viscosity: {q_lin: 0.3, q_quad: 2.0}\n"
       << "bodies:\n  block:\n    material: m\n    shape: {";
  if (axis)
    yaml << "cylinder: {radius: " << size << ", height: " << size << ", base: [0, 0, " << low
         << "]}}\n";
  else
    yaml << "box: {min: " << corner(low) << ", max: " << corner(low + size) << "}}\n";
  return yaml.str();
}

inline Overrides method(const std::string& shape, const std::string& transfer,
                        const std::string& update) {
  return {"method.shape=" + shape, "method.transfer=" + transfer, "method.update=" + update};
}
inline bool refused(const std::string& shape, const std::string& transfer,
                    const std::string& update) {
  if (shape == "linear" && (update == "usl" || transfer == "tflip" || transfer == "apic"))
    return true;
  if (transfer == "xpic" && update != "usl") return true;
  return shape == "gimp" && transfer == "flip" && update == "usl";
}

/// The default scheme of a shape.
inline Overrides scheme_of(const std::string& shape) {
  return shape == "linear" ? method(shape, "flip", "musl") : method(shape, "tflip", "usl");
}

/// Calls `check(frame, overrides, name)` for every scheme in every frame.
template <class Check>
void for_each_scheme(const Check& check) {
  for (const std::string& frame : kFrames)
    for (const std::string& shape : kShapes)
      for (const std::string& transfer : kTransfers)
        for (const std::string& update : kUpdates)
          if (!refused(shape, transfer, update))
            check(frame, method(shape, transfer, update),
                  frame + " " + shape + " " + transfer + " " + update);
}

struct Random {
  std::mt19937_64 engine{7};
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(engine);
  }
  std::vector<double> many(std::size_t n, double low, double high) {
    std::vector<double> x(n);
    for (double& value : x) value = (*this)(low, high);
    return x;
  }
};

inline void randomize(Run& run, const FieldInfo& field, double low, double high, Random& random) {
  const Column* c = run.sim->bodies()[0]->layout().find(field.name);
  REQUIRE(c != nullptr);
  for (int k = 0; k < c->components; ++k)
    set_column(run, field, k, random.many(run.sim->point_count(), low, high));
}

/// Fixed reference: F near the identity, another one for every point.
inline void distort(Run& run, Random& random) {
  const int dim = run.sim->geometry().dimension;
  for (int i = 0; i < dim; ++i)
    for (int a = 0; a < dim; ++a) {
      std::vector<double> F = random.many(run.sim->point_count(), -0.25, 0.25);
      for (double& x : F) x += i == a ? 1 : 0;
      set_column(run, field::ConfigurationMap::info, dim * i + a, F);
    }
}

inline double largest(const std::vector<double>& x) {
  double worst = 0;
  for (const double value : x) worst = std::max(worst, std::abs(value));
  return worst;
}

/// A rotation about the axis (1, 2, 3) in 3d, about y in two dimensions, over tensor axes.
inline std::array<std::array<double, 3>, 3> rotation(int dim, double angle) {
  const double n = std::sqrt(14.0);
  const std::array<double, 3> u =
      dim == 3 ? std::array<double, 3>{1 / n, 2 / n, 3 / n} : std::array<double, 3>{0, 1, 0};
  const double c = std::cos(angle), s = std::sin(angle);
  std::array<std::array<double, 3>, 3> R{};
  for (unsigned i = 0; i < 3; ++i)
    for (unsigned j = 0; j < 3; ++j) R[i][j] = u[i] * u[j] * (1 - c) + (i == j ? c : 0);
  R[0][1] -= u[2] * s, R[1][0] += u[2] * s;
  R[0][2] += u[1] * s, R[2][0] -= u[1] * s;
  R[1][2] -= u[0] * s, R[2][1] += u[0] * s;
  return R;
}

}  // namespace krater::test
