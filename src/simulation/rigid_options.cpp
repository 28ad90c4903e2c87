// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/body.hpp"

namespace krater {

namespace {

constexpr double kCut =
    1e-6;  // cells by which a body may miss a plane of symmetry and is cut by it

}  // namespace

RigidOptions rigid_options(const Scene& scene, const Body& body, int index) {
  const BodyOptions& options = body.options();
  RigidOptions out;
  out.name = body.name();
  out.where = options.where;
  out.body = index;
  out.free = options.motion == Motion::free;
  if (options.velocity)
    out.velocity = [field = options.velocity](const Triple& x, const Triple& X, double t) {
      return (*field)(x, X, t);
    };
  out.reference = body.slot(field::ReferencePosition::info) * kLanes;
  const int dim = dimension(scene.frame);
  for (int a = 0; a < dim; ++a) out.translates[static_cast<unsigned>(a)] = true;
  if (dim == 3) out.turns = {true, true, true};
  if (scene.frame == Frame::plane_strain) out.turns[2] = true;
  if (scene.frame == Frame::axisymmetric) out.translates[0] = false;
  const Box extent = options.solid->extent(scene.frame);
  for (int a = 0; a < dim; ++a) {
    const auto k = static_cast<unsigned>(a);
    const auto& sides = scene.grid.boundary[k];
    const double near = kCut * scene.grid.cell;
    const bool low = sides[0].kind == BoundaryKind::symmetry &&
                     extent.min[k] < scene.grid.min[k] + near,
               high = sides[1].kind == BoundaryKind::symmetry &&
                      extent.max[k] > scene.grid.max[k] - near;
    if (!low && !high) continue;
    out.translates[k] = false;
    for (int b = 0; b < 3; ++b)
      if (b != a) out.turns[static_cast<unsigned>(b)] = false;
  }
  return out;
}

std::string describe_motion(Frame frame, const RigidOptions& options) {
  std::string along, about;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<unsigned>(a);
    if (options.translates[k])
      along += (along.empty() ? " moves along " : ", ") + std::string{axis_name(frame, a)};
    if (!options.turns[k]) continue;
    const std::string axis{frame == Frame::plane_strain ? "y" : axis_name(frame, a)};
    about += (about.empty() ? " turns about " : ", ") + axis;
  }
  if (along.empty() && about.empty()) return " held on all sides";
  return along + (along.empty() || about.empty() ? "" : ";") + about;
}

}  // namespace krater
