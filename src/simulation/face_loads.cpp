// SPDX-License-Identifier: GPL-3.0-or-later
// Which points belong to the faces of loads: at the start, by the body's own shape.
#include <algorithm>

#include "krater/core/errors.hpp"
#include "krater/core/ranks.hpp"
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

/// Share of what lies `depth` below a face of a body that is `thickness` deep there.
double share_at(const Scene& scene, const FaceLoad& load, const BodyOptions& body, double depth,
                double thickness) {
  const bool drives = load.kind == FaceLoad::Kind::velocity;
  if (body.sph && !drives) return sph_load_share(*body.sph, depth, thickness);
  const double whole =
      body.sph ? body.sph->spacing : (drives ? kDrivenDepth : kLoadedDepth) * scene.grid.cell;
  return depth <= whole ? 1 : 0;
}

}  // namespace

double face_share(const Scene& scene, const FaceLoad& load, const BodyOptions& body,
                  const Triple& x) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension(scene.frame)); ++a)
    if (x[a] < load.region[a][0] || x[a] > load.region[a][1]) return 0;
  if (load.inside && !load.inside(x)) return 0;
  if (load.axis < 0) return 1;
  const auto a = static_cast<std::size_t>(load.axis);
  Spans spans;
  body.solid->spans(along_axis(to_space(scene.frame, x), tensor_axis(scene.frame, load.axis)),
                    spans);
  for (const Span& span : spans) {
    if (x[a] < span.low || x[a] > span.high) continue;
    const double low = std::max(span.low, scene.grid.min[a]),
                 high = std::min(span.high, scene.grid.max[a]);
    return share_at(scene, load, body, load.side == 0 ? x[a] - low : high - x[a], high - low);
  }
  return 0;
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
    if (!(ranks::max(marks_any(sim, static_cast<int>(k)) ? 1 : 0) > 0))
      throw InputError(faces[k].where +
                       ": no point of its body lies there at the start, so the load has nothing to "
                       "act on; where and inside are bounds of the material's place at the start "
                       "and should reach four cells below the loaded surface");
}

}  // namespace krater
