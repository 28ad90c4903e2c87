// SPDX-License-Identifier: GPL-3.0-or-later
// Which points belong to the faces of loads: at the start, by the body's own shape.
#include <algorithm>
#include <cmath>

#include "krater/core/errors.hpp"
#include "krater/kinematics/mpm/node_loads.hpp"
#include "krater/kinematics/sph/sph_loads.hpp"
#include "krater/points/load_fields.hpp"
#include "krater/simulation/face_loads.hpp"

namespace krater {

std::vector<int> loads_of(const Scene& scene, int body) {
  std::vector<int> out;
  for (std::size_t k = 0; k < scene.loads.faces.size(); ++k) {
    const std::vector<int>& bodies = scene.loads.faces[k].bodies;
    if (std::find(bodies.begin(), bodies.end(), body) != bodies.end())
      out.push_back(static_cast<int>(k));
  }
  return out;
}

namespace {

double depth_of(const Scene& scene, const FaceLoad& load, const BodyOptions& body) {
  if (body.sph) return sph_load_depth(*body.sph, load.kind);
  return (load.kind == FaceLoad::Kind::velocity ? kDrivenDepth : kLoadedDepth) * scene.grid.cell;
}

}  // namespace

bool lies_on_face(const Scene& scene, const FaceLoad& load, const BodyOptions& body,
                  const Triple& x) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(scene.frame)); ++a)
    if (x[a] < load.region[a][0] || x[a] > load.region[a][1]) return false;
  if (load.inside && !load.inside(x)) return false;
  if (load.axis < 0) return true;
  const auto a = static_cast<std::size_t>(load.axis);
  const std::size_t side = load.side == 0 ? 0 : 1;
  const std::array<double, 2> domain{scene.grid.min[a], scene.grid.max[a]};
  Spans spans;
  body.solid->spans(along_axis(to_space(scene.frame, x), tensor_axis(scene.frame, load.axis)),
                    spans);
  return std::any_of(spans.begin(), spans.end(), [&](const Span& span) {
    const std::array<double, 2> ends{std::max(span.low, domain[0]), std::min(span.high, domain[1])};
    double depth = depth_of(scene, load, body);
    // The sums of particles know the faces on both sides; what a mirror completes has only one.
    const bool mirrored = ends[1 - side] == domain[1 - side] &&
                          scene.grid.boundary[a][1 - side].kind == BoundaryKind::symmetry;
    if (body.sph && !mirrored) depth = std::min(depth, 0.5 * (ends[1] - ends[0]));
    return x[a] >= span.low && x[a] <= span.high && std::abs(x[a] - ends[side]) <= depth;
  });
}

namespace {

bool marks_any(const Simulation& sim, int face) {
  if (sim.mesh() != nullptr && sim.mesh()->feels(static_cast<std::size_t>(face))) return true;
  for (int s = 0; s < sim.set_count(); ++s) {
    if (sim.is_mesh_set(s)) continue;
    const std::vector<int> loads = loads_of(sim.scene(), sim.set(s).body);
    const auto at = std::find(loads.begin(), loads.end(), face);
    if (at == loads.end()) continue;
    const int mark = sim.bodies()[static_cast<std::size_t>(sim.set(s).body)]->slot(
        field::LoadShare::info, static_cast<int>(at - loads.begin()));
    for (int i = 0; i < sim.set(s).count(); ++i)
      if (sim.value(s, i, mark) > 0) return true;
  }
  return false;
}

}  // namespace

void require_faces(const Simulation& sim) {
  const std::vector<FaceLoad>& faces = sim.scene().loads.faces;
  for (std::size_t k = 0; k < faces.size(); ++k)
    if (!marks_any(sim, static_cast<int>(k)))
      throw InputError(faces[k].where +
                       ": no point of its body lies there at the start, so the load has nothing to "
                       "act on; where and inside are bounds of the material's place at the start "
                       "and should reach four cells below the loaded surface");
}

}  // namespace krater
