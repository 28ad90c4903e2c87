// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry of elements and their hourglass modes: identities that hold on any element.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "krater/kinematics/mesh/hexahedron.hpp"
#include "krater/kinematics/mesh/hourglass.hpp"
#include "krater/kinematics/mesh/mesh.hpp"
#include "krater/kinematics/mesh/mesh_health.hpp"

namespace {

using namespace krater;

template <int Dim>
struct Shape {
  static constexpr int nodes = corner_nodes(Dim);
  double x[nodes][Dim];
};

/// A unit element with its corners moved by up to `distortion`, away from the axis by `away`.
template <int Dim>
Shape<Dim> distorted(unsigned seed, double distortion, double away = 0) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> move{-distortion, distortion};
  Shape<Dim> s;
  for (int I = 0; I < corner_nodes(Dim); ++I)
    for (int a = 0; a < Dim; ++a)
      s.x[I][a] = 0.5 * (1 + corner_sign(Dim, I, a)) + move(random) + (a == 0 ? away : 0);
  return s;
}

template <class Frame>
ElementGeometry<double, Frame> geometry(const Shape<Frame::dim>& s) {
  ElementGeometry<double, Frame> e;
  find_geometry(s.x, e);
  return e;
}

/// The same volume by the Gauss points of the corner masses.
double gauss_volume(const Mesh& mesh, bool axisymmetric) {
  double sum = 0;
  for (const double v : corner_volumes(mesh, axisymmetric)) sum += v;
  return sum;
}
template <int Dim>
Mesh mesh_of(const Shape<Dim>& s) {
  Mesh mesh{Dim, {}, {}};
  for (int I = 0; I < corner_nodes(Dim); ++I) {
    Triple x{};
    for (int a = 0; a < Dim; ++a) x[static_cast<std::size_t>(a)] = s.x[I][a];
    mesh.nodes.push_back(x);
    mesh.elements.push_back(I);
  }
  return mesh;
}

template <class Frame>
void check_geometry(unsigned seed) {
  constexpr int D = Frame::dim, N = corner_nodes(D);
  const Shape<D> s = distorted<D>(seed, 0.2, Frame::hoop ? 0.5 : 0);
  const auto e = geometry<Frame>(s);
  CHECK(e.volume == doctest::Approx(gauss_volume(mesh_of(s), Frame::hoop)).epsilon(1e-13));
  for (int a = 0; a < D; ++a) {
    double sum = 0, moments[3] = {};
    for (int I = 0; I < N; ++I) {
      sum += e.b[I][a];
      for (int i = 0; i < D; ++i) moments[i] += s.x[I][i] * e.b[I][a];
      // b (and the hoop's part) is the derivative of the volume.
      const double step = 1e-5;
      Shape<D> up = s, down = s;
      up.x[I][a] += step, down.x[I][a] -= step;
      const double slope = (geometry<Frame>(up).volume - geometry<Frame>(down).volume) / (2 * step);
      CHECK(e.b[I][a] + (Frame::hoop && a == 0 ? e.t[I] : 0.0) ==
            doctest::Approx(slope).epsilon(1e-8));
    }
    CHECK(std::abs(sum) < 1e-14);
    for (int i = 0; i < D; ++i)
      CHECK(moments[i] == doctest::Approx(i == a ? e.volume : 0.0).epsilon(1e-13));
  }
  if constexpr (Frame::hoop) {  // v = r: the hoop's rate is 1
    double rate = 0;
    for (int I = 0; I < N; ++I) rate += s.x[I][0] * e.t[I];
    CHECK(rate == doctest::Approx(e.volume).epsilon(1e-13));
  }
}

template <class Frame>
HourglassFrame<double, Frame::dim> hourglass(const Shape<Frame::dim>& s) {
  HourglassFrame<double, Frame::dim> h;
  find_hourglass(geometry<Frame>(s), s.x, h);
  return h;
}

template <class Frame>
void check_orthogonal(unsigned seed) {
  constexpr int D = Frame::dim;
  const Shape<D> s = distorted<D>(seed, 0.2, Frame::hoop ? 0.5 : 0);
  const auto h = hourglass<Frame>(s);
  for (int a = 0; a < hourglass_modes(D); ++a) {
    double sum = 0, moments[3] = {}, own = 0;
    for (int I = 0; I < corner_nodes(D); ++I) {
      sum += h.gamma[a][I];
      own += h.gamma[a][I] * hourglass_mode(D, a, I);
      for (int i = 0; i < D; ++i) moments[i] += h.gamma[a][I] * s.x[I][i];
    }
    CHECK(std::abs(sum) < 1e-15);
    CHECK(own > 0.5);
    for (const double m : moments) CHECK(std::abs(m) < 1e-15);
  }
}

/// Stiffness of a brick a_1 x a_2 x a_3 (half edges) against q_ka = e_k . u of mode `mode` along k,
/// when the mode that goes with it is free.
double bending_stiffness(const double (&half)[3], int k, int mode, double mu, double nu) {
  Shape<3> s;
  for (int I = 0; I < 8; ++I)
    for (int a = 0; a < 3; ++a) s.x[I][a] = half[a] * corner_sign(3, I, a);
  const auto h = hourglass<Cartesian<3>>(s);
  const auto e = geometry<Cartesian<3>>(s);
  const auto stiffness = [&](int to, int from) {
    double dq[12] = {}, Q[12] = {};
    dq[from] = 1;
    add_hourglass_stress<double, 3>(h, dq, mu, nu, e.volume, Q);
    return Q[to];
  };
  const int own = 4 * k + mode, other = 4 * mode + k;
  CHECK(stiffness(own, other) == doctest::Approx(stiffness(other, own)));
  return stiffness(own, own) -
         stiffness(own, other) * stiffness(other, own) / stiffness(other, other);
}

}  // namespace

TEST_SUITE("unit") {
  // hexahedron.hpp is another way to the same numbers: each against the sums over corners.
  TEST_CASE("element: the modes of a hexahedron give what its corners give") {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const Shape<3> s = distorted<3>(seed, 0.25, 3.0);
      const auto e = geometry<Cartesian<3>>(s);
      Hexahedron<double> h;
      find_modes(s.x, h.a);
      h.find_slopes();
      CHECK(h.volume == doctest::Approx(e.volume).epsilon(1e-13));
      std::mt19937 random{seed};
      std::uniform_real_distribution<double> any{-1, 1};
      double v[8][3], Q[12], share[8], stress[6];
      for (auto& corner : v)
        for (double& x : corner) x = any(random);
      for (double& x : Q) x = any(random);
      for (double& x : share) x = 2 + any(random);
      for (double& x : stress) x = any(random);
      const Sym3<double> sigma{stress[0], stress[1], stress[2], stress[3], stress[4], stress[5]};
      CornerModes<double> u;
      find_modes(v, u);
      const Mat3<double> L = h.gradient(u, 1 / h.volume),
                         by_corners = mean_gradient(e, v, 1 / e.volume);
      CHECK(L.xx == doctest::Approx(by_corners.xx).epsilon(1e-12));
      CHECK(L.xy == doctest::Approx(by_corners.xy).epsilon(1e-12));
      CHECK(L.yz == doctest::Approx(by_corners.yz).epsilon(1e-12));
      CHECK(L.zx == doctest::Approx(by_corners.zx).epsilon(1e-12));
      HourglassFrame<double, 3> frame;
      find_hourglass(e, s.x, frame);
      double rates[12], q[4][3], directions[3][3], per_a[3], F[4][3];
      hourglass_rates<double, 3>(frame, v, rates);
      h.hourglass_of(u, L, 1.0, q);
      h.directions(directions, per_a);
      for (int k = 0; k < 3; ++k) {
        CHECK(per_a[k] == doctest::Approx(frame.per_a[k]).epsilon(1e-13));
        for (int a = 0; a < 4; ++a)
          CHECK(std::abs(dot3(directions[k], q[a]) - rates[4 * k + a]) < 1e-13);
      }
      for (int a = 0; a < 4; ++a)
        for (int i = 0; i < 3; ++i) {
          F[a][i] = 0;
          for (int k = 0; k < 3; ++k) F[a][i] += directions[k][i] * Q[4 * k + a];
        }
      double f[8][3], g[8][3] = {};
      h.forces(sigma, F, f);
      add_stress_force(e, sigma, g);
      add_hourglass_force<double, 3>(frame, Q, g);
      for (int I = 0; I < 8; ++I)
        for (int i = 0; i < 3; ++i) CHECK(std::abs(f[I][i] - g[I][i]) < 1e-13);
      CHECK(h.stable_length(share, 1.5) ==
            doctest::Approx(stable_length(e, share, 1.5)).epsilon(1e-13));
      CHECK(h.squares() == doctest::Approx(squares_of(e)).epsilon(1e-13));
    }
  }

  TEST_CASE("elements: b is the derivative of the volume, and linear fields are exact") {
    for (unsigned seed = 1; seed < 5; ++seed) {
      check_geometry<Cartesian<3>>(seed);
      check_geometry<Cartesian<2>>(seed);
      check_geometry<Axisymmetric>(seed);
    }
  }

  TEST_CASE("elements: hourglass modes see no linear field") {
    for (unsigned seed = 1; seed < 5; ++seed) {
      check_orthogonal<Cartesian<3>>(seed);
      check_orthogonal<Cartesian<2>>(seed);
      check_orthogonal<Axisymmetric>(seed);
    }
  }

  TEST_CASE("elements: one brick bends as a beam does, whatever its proportions") {
    const double half[3] = {1.0, 0.4, 0.15}, E = 210, V = 8 * half[0] * half[1] * half[2];
    for (const double nu : {0.0, 0.3, 0.4999}) {
      const double mu = E / (2 * (1 + nu));
      // u_k = q times two coordinates: strain q/a_k over the third one, energy E q^2 V/(6 a_k^2).
      for (int k = 0; k < 3; ++k)
        for (int mode = 0; mode < 3; ++mode)
          if (mode != k)
            CHECK(bending_stiffness(half, k, mode, mu, nu) ==
                  doctest::Approx(E * V / (3 * half[k] * half[k])).epsilon(1e-12));
    }
  }

  TEST_CASE("meshes: a corner that is pushed through its element is seen") {
    const auto corners = [](int dim) {
      std::vector<Triple> x;
      for (int I = 0; I < corner_nodes(dim); ++I)
        x.push_back({corner_sign(dim, I, 0), 3 * corner_sign(dim, I, 1),
                     dim == 3 ? 0.5 * corner_sign(dim, I, 2) : 0});
      return x;
    };
    for (const int dim : {2, 3})
      for (std::size_t I = 0; I < corners(dim).size(); ++I) {
        std::vector<Triple> x = corners(dim);
        for (Triple& p : x) p[0] += 0.7 * p[1];  // a parallelepiped
        CHECK(least_corner(dim, x) == doctest::Approx(1).epsilon(1e-14));
        const auto pushed = [&](double share) {
          std::vector<Triple> y = x;
          for (std::size_t a = 0; a < 3; ++a) y[I][a] *= 1 - share;
          return least_corner(dim, y);
        };
        // Beyond the middle of the corners beside it: the centre, or a third of the way out.
        const double flat = dim == 2 ? 1 : 2.0 / 3;
        CHECK(pushed(0.9 * flat) > 0);
        CHECK(pushed(1.1 * flat) < 0);
        for (Triple& p : x) std::swap(p[0], p[1]);
        CHECK(least_corner(dim, x) == doctest::Approx(-1).epsilon(1e-14));
      }
  }

  TEST_CASE("meshes: a block's corners sum to its volume and keep its centre") {
    const Mesh mesh = block_mesh(2, {0, 1, 0}, {2, 4, 0}, {3, 5, 1});
    CHECK(mesh.element_count() == 15);
    CHECK(gauss_volume(mesh, false) == doctest::Approx(6));
    CHECK(gauss_volume(mesh, true) == doctest::Approx(3.14159265358979 * 4 * 3));
    CHECK(gauss_volume(block_mesh(3, {0, 0, 0}, {1, 2, 3}, {2, 2, 2}), false) ==
          doctest::Approx(6));
    const NodeCorners at = node_corners(mesh);
    CHECK(at.first.back() == 60);
  }
}
