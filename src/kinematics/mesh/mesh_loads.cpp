// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/mesh_loads.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/mesh/elements.hpp"

namespace krater {

namespace {

constexpr double kLooks = 1e-6;  // cosine above which a face looks along an axis

using Face = std::array<std::int32_t, 4>;
using Areas = std::array<Triple, 4>;  // int N_I n dA of the corners of a face

std::size_t corners_of(const Face& face) { return face[2] < 0 ? 2 : 4; }

Areas edge_areas(const std::array<Triple, 4>& x, bool round) {
  Areas out{};
  const double g = 0.5 / std::sqrt(3.0);
  for (const double s : {0.5 - g, 0.5 + g}) {
    const double r = (1 - s) * x[0][0] + s * x[1][0], w = round ? 2 * std::numbers::pi * r : 1.0;
    for (std::size_t I = 0; I < 2; ++I) {
      const double N = 0.5 * w * (I == 0 ? 1 - s : s);  // outwards is to the right
      out[I][0] += N * (x[1][1] - x[0][1]);
      out[I][1] -= N * (x[1][0] - x[0][0]);
    }
  }
  return out;
}

Areas quad_areas(const std::array<Triple, 4>& x) {
  Areas out{};
  const double g = 0.5 / std::sqrt(3.0);
  for (const double s : {0.5 - g, 0.5 + g})
    for (const double t : {0.5 - g, 0.5 + g}) {
      Triple by_s{}, by_t{};
      for (std::size_t a = 0; a < 3; ++a) {
        by_s[a] = (1 - t) * (x[1][a] - x[0][a]) + t * (x[2][a] - x[3][a]);
        by_t[a] = (1 - s) * (x[3][a] - x[0][a]) + s * (x[2][a] - x[1][a]);
      }
      const Triple n = cross(by_s, by_t);
      const std::array<double, 4> N{(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
      for (std::size_t I = 0; I < 4; ++I)
        for (std::size_t a = 0; a < 3; ++a) out[I][a] += 0.25 * N[I] * n[a];
    }
  return out;
}

Areas areas_of(const std::array<Triple, 4>& x, const Face& face, bool round) {
  return corners_of(face) == 2 ? edge_areas(x, round) : quad_areas(x);
}

/// On a plane of symmetry or the axis: no face of the whole body.
bool lies_on_plane(const MeshStep::Elements& b, const Face& face) {
  unsigned planes = ~0U;
  for (const std::int32_t n : face)
    if (n >= 0) planes &= b.on_plane[static_cast<std::size_t>(n)];
  return planes != 0;
}

double outwards(const FaceLoad& load) { return load.side == 0 ? -1 : 1; }

}  // namespace

MeshLoads::MeshLoads(const LoadOptions& options, Acceleration body_force, Frame frame)
    : options_{options}, body_force_{std::move(body_force)}, frame_{frame} {}

/// By where the face was at the start, and how it looked.
bool MeshLoads::selects(const FaceLoad& load, const Mesh& mesh, const Face& face) const {
  std::array<Triple, 4> x{};
  Triple middle{}, area{};
  const std::size_t corners = corners_of(face);
  for (std::size_t I = 0; I < corners; ++I) {
    x[I] = mesh.nodes[static_cast<std::size_t>(face[I])];
    for (std::size_t a = 0; a < 3; ++a) middle[a] += x[I][a] / static_cast<double>(corners);
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(frame_)); ++a)
    if (middle[a] < load.region[a][0] || middle[a] > load.region[a][1]) return false;
  if (load.inside && !load.inside(middle)) return false;
  if (load.axis < 0) return true;
  for (const Triple& part : areas_of(x, face, false))
    for (std::size_t a = 0; a < 3; ++a) area[a] += part[a];
  return outwards(load) * area[static_cast<std::size_t>(load.axis)] >
         kLooks * std::sqrt(dot(area, area));
}

void MeshLoads::find_faces(const MeshStep::Elements& b, OfBody& out) const {
  const std::size_t now = b.made_of.mesh.element_count();
  if (out.elements == now) return;  // elements are taken out, and never put back
  out.elements = now;
  out.faces.clear();
  const std::vector<Face> now_exposed = faces_of(b), at_start = first_faces_of(b);
  for (std::size_t k = 0; k < options_.faces.size(); ++k) {
    const std::vector<int>& bodies = options_.faces[k].bodies;
    if (std::find(bodies.begin(), bodies.end(), b.made_of.body) == bodies.end()) continue;
    const bool follows = options_.faces[k].kind == FaceLoad::Kind::pressure && !b.converts();
    for (const Face& face : follows ? now_exposed : at_start)
      if (!lies_on_plane(b, face) && selects(options_.faces[k], b.made_of.mesh, face))
        out.faces.push_back({k, face});
  }
}

bool MeshLoads::acts(std::size_t load, const MeshStep::Elements& b) const {
  OfBody of;
  find_faces(b, of);
  return std::any_of(of.faces.begin(), of.faces.end(),
                     [load](const Loaded& l) { return l.load == load; });
}

void MeshLoads::add(MeshStep::Elements& b, double dt) {
  if (!any()) return;
  OfBody& of = bodies_[&b];
  find_faces(b, of);
  of.changes.begin(b.node_count);
  press(b, of, dt);
  of.changes.push(masses(b), body_force_, options_.damping, time_, dt);
  drive(b, of);
}

/// Pressures and tractions.
void MeshLoads::press(MeshStep::Elements& b, OfBody& of, double dt) const {
  for (const Loaded& loaded : of.faces) {
    const FaceLoad& load = options_.faces[loaded.load];
    if (load.kind == FaceLoad::Kind::velocity) continue;
    Triple value{};
    for (std::size_t a = 0; a < 3; ++a) value[a] = load.value[a] ? load.value[a](time_) : 0;
    std::array<Triple, 4> x{};
    for (std::size_t I = 0; I < corners_of(loaded.face); ++I) {
      const double* node = b.node(static_cast<std::size_t>(loaded.face[I]));
      x[I] = {node[0], node[1], node[2]};
    }
    const Areas areas = areas_of(x, loaded.face, frame_ == Frame::axisymmetric);
    for (std::size_t I = 0; I < corners_of(loaded.face); ++I) {
      const auto n = static_cast<std::size_t>(loaded.face[I]);
      for (std::size_t a = 0; a < 3; ++a) {
        const double force =
            load.kind == FaceLoad::Kind::pressure
                ? -value[0] * areas[I][a]
                : value[a] *
                      std::max(0.0, outwards(load) * areas[I][static_cast<std::size_t>(load.axis)]);
        of.changes.give(n, a, b.change(n), dt * force / b.node(n)[3]);
      }
    }
  }
}

LoadChanges::Masses MeshLoads::masses(MeshStep::Elements& b) const {
  return {b.node_count, dimension(frame_), [&b](std::size_t n) {
            const double* node = b.node(n);
            return LoadedMass{node[3],
                              {node[0], node[1], node[2]},
                              b.made_of.mesh.nodes[n],
                              {node[4], node[5], node[6]},
                              b.change(n)};
          }};
}

void MeshLoads::drive(MeshStep::Elements& b, OfBody& of) const {
  for (const Loaded& loaded : of.faces) {
    const FaceLoad& load = options_.faces[loaded.load];
    if (load.kind != FaceLoad::Kind::velocity) continue;
    for (std::size_t I = 0; I < corners_of(loaded.face); ++I) {
      const auto n = static_cast<std::size_t>(loaded.face[I]);
      for (std::size_t a = 0; a < 3; ++a) {
        if (!load.value[a]) continue;
        const double more = load.value[a](time_) - b.node(n)[4 + a] - b.change(n)[a];
        of.changes.give(n, a, b.change(n), more);
      }
    }
  }
}

void MeshLoads::book(MeshStep::Elements& b, Audit& audit) const {
  const auto at = bodies_.find(&b);
  if (at != bodies_.end()) at->second.changes.book(masses(b), audit);
}

}  // namespace krater
