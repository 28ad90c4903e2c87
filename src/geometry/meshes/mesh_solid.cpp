// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/meshes/mesh_solid.hpp"

#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "krater/geometry/solids/csg.hpp"
#include "krater/geometry/solids/profile.hpp"
#include "krater/geometry/surfaces/surface.hpp"

namespace krater {

namespace {

using SolidPointer = std::shared_ptr<const Solid>;
using Loop = std::vector<std::array<double, 2>>;

/// Closed lines of exposed edges, material at the left.
std::vector<Loop> loops_of(const Mesh& mesh) {
  std::map<std::int32_t, std::int32_t> next;
  for (const MeshFace& edge : exposed_faces(mesh))
    if (!next.try_emplace(edge[0], edge[1]).second) {
      const Vector3& x = mesh.nodes[static_cast<std::size_t>(edge[0])];
      throw std::invalid_argument(fmt::format(
          "the mesh touches itself in a single node at ({:g}, {:g}) m: join what meets there by "
          "an edge, or make it bodies of their own",
          x[0], x[1]));
    }
  std::vector<Loop> out;
  while (!next.empty()) {
    Loop loop;
    std::int32_t at = next.begin()->first;
    for (auto found = next.find(at); found != next.end(); found = next.find(at)) {
      const Vector3& x = mesh.nodes[static_cast<std::size_t>(at)];
      loop.push_back({x[0], x[1]});
      at = found->second;
      next.erase(found);
    }
    out.push_back(std::move(loop));
  }
  return out;
}

double area_of(const Loop& loop) {
  double twice = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const auto &a = loop[k], &b = loop[(k + 1) % loop.size()];
    twice += (a[0] - loop[0][0]) * (b[1] - loop[0][1]) - (b[0] - loop[0][0]) * (a[1] - loop[0][1]);
  }
  return 0.5 * twice;
}

SolidPointer fill(const Loop& loop, Frame frame) {
  if (frame == Frame::axisymmetric) return make_revolution(polygon_profile(loop));
  Affine across;  // (u, v) and the length along z become x, z and y
  across.linear = {1, 0, 0, 0, 0, 1, 0, 1, 0};
  across.shift = {0, -0.5, 0};
  return transformed(make_extrusion(polygon_profile(loop), 1), across);
}

SolidPointer plane_solid(const Mesh& mesh, Frame frame) {
  std::vector<SolidPointer> whole, holes;
  for (const Loop& loop : loops_of(mesh))
    (area_of(loop) > 0 ? whole : holes).push_back(fill(loop, frame));
  SolidPointer out = whole.size() == 1 ? whole[0] : make_boolean(Boolean::unite, whole);
  if (holes.empty()) return out;
  holes.insert(holes.begin(), out);
  return make_boolean(Boolean::subtract, holes);
}

SolidPointer space_solid(const Mesh& mesh) {
  Triangles surface;
  surface.vertices = mesh.nodes;
  for (const MeshFace& face : exposed_faces(mesh)) {
    std::array<std::uint32_t, 4> n{};
    for (std::size_t k = 0; k < 4; ++k) n[k] = static_cast<std::uint32_t>(face[k]);
    surface.facets.push_back({n[0], n[1], n[2]});
    surface.facets.push_back({n[0], n[2], n[3]});
  }
  return make_surface_solid(std::move(surface));
}

class MeshSolid final : public Solid {
 public:
  MeshSolid(Mesh mesh, Frame frame, SolidPointer solid)
      : mesh_{std::move(mesh)}, frame_{frame}, solid_{std::move(solid)} {}

  using Solid::contains;

  const Mesh* elements() const override { return &mesh_; }
  void spans(const Line& line, Spans& out) const override { solid_->spans(line, out); }
  bool contains(double x, double y, double z) const override { return solid_->contains(x, y, z); }
  Box bounding_box() const override { return solid_->bounding_box(); }
  double support(const Vector3& d) const override { return solid_->support(d); }
  bool revolved_about(const Line& axis) const override { return solid_->revolved_about(axis); }
  std::optional<VolumeMoments> moments() const override { return solid_->moments(); }
  std::shared_ptr<const Solid> mapped(const Affine& map) const override {
    return std::make_shared<MeshSolid>(krater::mapped(mesh_, frame_, map), frame_,
                                       transformed(solid_, map));
  }
  void require(Frame frame) const override { solid_->require(frame); }
  Box extent(Frame frame) const override { return solid_->extent(frame); }
  Place classify(Frame frame, const Box& cell) const override {
    return solid_->classify(frame, cell);
  }
  CellPart clip(Frame frame, const Box& cell) const override { return solid_->clip(frame, cell); }
  void clip_column(Frame frame, std::span<const Box> cells, CellPart* parts) const override {
    solid_->clip_column(frame, cells, parts);
  }
  CellPart part(Frame frame, const Box& domain) const override {
    return solid_->part(frame, domain);
  }

 private:
  Mesh mesh_;
  Frame frame_;
  SolidPointer solid_;
};

}  // namespace

std::shared_ptr<const Solid> make_mesh_solid(Mesh mesh, Frame frame) {
  SolidPointer solid = dimension(frame) == 3 ? space_solid(mesh) : plane_solid(mesh, frame);
  return std::make_shared<MeshSolid>(std::move(mesh), frame, std::move(solid));
}

}  // namespace krater
