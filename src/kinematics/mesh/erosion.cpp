// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mesh/erosion.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "kinematics/mesh/elements.hpp"
#include "krater/core/parallel.hpp"

namespace krater {

namespace {

constexpr std::size_t kChunkGroups = 256;

/// Lane `i` of the records of `rows` rows each.
template <class T>
void copy_lane(T* records, std::size_t rows, int from, int to) {
  const auto at = [rows](int i) {
    return static_cast<std::size_t>(i / kLanes) * rows * kLanes +
           static_cast<std::size_t>(i % kLanes);
  };
  for (std::size_t r = 0; r < rows; ++r)
    records[at(to) + r * kLanes] = records[at(from) + r * kLanes];
}

void copy_element(MeshStep::Elements& b, int from, int to) {
  const std::size_t corners = b.corner_count(),
                    dim = static_cast<std::size_t>(b.made_of.mesh.dimension);
  copy_lane(b.corners.data(), corners, from, to);
  copy_lane(b.shares.data(), corners, from, to);
  const std::size_t doubles =
      corners * static_cast<std::size_t>(dim == 3 ? kForceDoubles<3> : kForceDoubles<2>);
  std::copy_n(b.forces.data() + doubles * static_cast<std::size_t>(from), doubles,
              b.forces.data() + doubles * static_cast<std::size_t>(to));
  copy_lane(b.hourglass.data(), dim == 3 ? 12 : 2, from, to);
  copy_lane(b.hourglass_energy.data(), 1, from, to);
  copy_lane(b.remembered.data(), kRemembered, from, to);
  if (b.placed_rows() > 0) copy_lane(b.placed.data(), b.placed_rows(), from, to);
}

/// Lanes beyond the last element repeat it.
void pad_lanes(MeshStep::Elements& b) {
  const int count = b.elements.count();
  for (int i = count; i < b.elements.groups() * kLanes; ++i) copy_element(b, count - 1, i);
  if (count > 0) b.elements.pad(b.columns.mass);
}

/// Element i and why it is taken out.
struct Gone {
  int i;
  double Eroded::*cause;
};

/// Why an element is taken out; null: it is not.
double Eroded::*cause_of(const MeshStep::Elements& b, int i, double least_corner) {
  const ErosionOptions& when = b.made_of.erosion;
  const ElementColumns& c = b.columns;
  if (when.failed && c.failed >= 0 && b.elements.at(c.failed, i) > 0.5) return &Eroded::failed;
  if (c.plastic >= 0 && b.elements.at(c.plastic, i) >= when.plastic_strain)
    return &Eroded::plastic_strain;
  const double ratio = b.made_of.density / b.elements.at(c.density, i);
  if (ratio < when.volume_ratio[0] || ratio > when.volume_ratio[1]) return &Eroded::volume_ratio;
  const double* remembered =
      b.remembered.data() + static_cast<std::size_t>(i / kLanes * kRemembered + 2) * kLanes;
  if (remembered[i % kLanes] * when.step > 1) return &Eroded::step;
  if (least_corner <= when.jacobian) return &Eroded::jacobian;
  return nullptr;
}

/// In the order of their places.
std::vector<Gone> find_eroded(const MeshStep::Elements& b) {
  const auto groups = static_cast<std::size_t>(b.elements.groups()),
             chunks = (groups + kChunkGroups - 1) / kChunkGroups;
  const bool corners = b.made_of.erosion.jacobian > -1e300;
  std::vector<std::vector<Gone>> found(chunks);
  for_each(chunks, [&](std::size_t c) {
    std::array<double, kLanes> least;
    least.fill(1);
    for (std::size_t g = c * kChunkGroups; g < std::min((c + 1) * kChunkGroups, groups); ++g) {
      if (corners) least = least_corners(b, g);
      const int first = static_cast<int>(g) * kLanes;
      for (int i = first; i < std::min(first + kLanes, b.elements.count()); ++i)
        if (const auto cause = cause_of(b, i, least[static_cast<std::size_t>(i - first)]))
          found[c].push_back({i, cause});
    }
  });
  std::vector<Gone> out;
  for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
  return out;
}

/// Masses of the nodes, of the elements that are left; summed again, for a difference would leave
/// round-off where none is left.
void weigh_nodes(MeshStep::Elements& b) {
  const std::size_t corners = b.corner_count();
  for (std::size_t n = 0; n < b.node_count; ++n) b.node(n)[3] = 0;
  for (std::size_t id = 0; id < b.first.alive.size(); ++id)
    for (std::size_t I = 0; b.first.alive[id] && I < corners; ++I)
      b.node(static_cast<std::size_t>(b.first.corners[id * corners + I]))[3] +=
          b.first.shares[id * corners + I];
  for (std::size_t n = 0; n < b.node_count; ++n)
    if (b.node(n)[3] == 0) std::fill_n(b.node(n) + 4, 4, 0.0);
}

/// What nodes have, when elements have changed; in an order that does not depend on which went
/// first.
void find_nodes_again(MeshStep::Elements& b) {
  const std::size_t corners = b.corner_count();
  std::fill(b.orphaned.begin(), b.orphaned.end(), 0.0);
  for (std::size_t id = 0; !b.converts() && id < b.first.alive.size(); ++id)
    for (std::size_t I = 0; !b.first.alive[id] && I < corners; ++I)
      b.orphaned[static_cast<std::size_t>(b.first.corners[id * corners + I])] +=
          b.first.shares[id * corners + I];
  if (b.converts()) weigh_nodes(b);
  pad_lanes(b);
  b.corners_of = node_corners(b.made_of.mesh);
  b.surface.clear();
}

void book_eroded(const MeshStep::Elements& b, int i, Audit& audit) {
  Removed energy;
  energy.internal = b.elements.at(b.columns.mass, i) * b.elements.at(b.columns.energy, i) +
                    b.hourglass_energy.data()[i];
  energy.count = energy.failed = 1;
  audit.book_removed(energy);
  if (!b.made_of.barotropic) return;
  audit.unfelt -= energy.internal;
  audit.unfelt_removed += energy.internal;
}

/// From the last on, so that those to come keep their places.
void take_out(MeshStep::Elements& b, const std::vector<Gone>& gone, bool axisymmetric,
              Audit& audit) {
  const std::size_t corners = b.corner_count();
  std::vector<std::int32_t>& mesh = b.made_of.mesh.elements;
  for (auto at = gone.rbegin(); at != gone.rend(); ++at) {
    const int i = at->i, last = b.elements.count() - 1;
    b.eroded.*at->cause += 1;
    const auto id = static_cast<std::size_t>(b.elements.at(b.columns.id, i));
    b.first.alive[id] = false;
    if (b.converts())
      convert_element(b, i, axisymmetric);
    else
      book_eroded(b, i, audit);
    b.elements.copy(last, i);
    copy_element(b, last, i);
    b.elements.truncate(last);
    std::copy_n(mesh.begin() + static_cast<std::ptrdiff_t>(corners) * last, corners,
                mesh.begin() + static_cast<std::ptrdiff_t>(corners) * i);
    mesh.resize(mesh.size() - corners);
  }
  find_nodes_again(b);
}

}  // namespace

ElementNeighbours find_neighbours(const Mesh& mesh) {
  const auto& faces = element_faces(mesh.dimension);
  const auto corners = static_cast<std::size_t>(mesh.corners());
  ElementNeighbours out;
  out.corners = mesh.elements;
  out.alive.assign(mesh.element_count(), true);
  out.beside.assign(mesh.element_count() * faces.size(), -1);
  std::map<std::array<std::int32_t, 4>, std::size_t> open;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (std::size_t f = 0; f < faces.size(); ++f) {
      std::array<std::int32_t, 4> key{-1, -1, -1, -1};
      for (std::size_t k = 0; k < faces[f].size(); ++k)
        key[k] = mesh.elements[e * corners + faces[f][k]];
      std::sort(key.begin(), key.end());
      const std::size_t place = e * faces.size() + f;
      const auto [at, is_new] = open.try_emplace(key, place);
      if (is_new) continue;
      out.beside[place] = static_cast<std::int32_t>(at->second / faces.size());
      out.beside[at->second] = static_cast<std::int32_t>(e);
      open.erase(at);
    }
  return out;
}

namespace {

/// Of elements that are left, where nothing was beside them or, if asked, where nothing is now.
std::vector<std::array<std::int32_t, 4>> exposed_now(const MeshStep::Elements& b, bool also_new) {
  if (!b.erodes()) return exposed_faces(b.made_of.mesh);
  const auto& faces = element_faces(b.made_of.mesh.dimension);
  const ElementNeighbours& first = b.first;
  std::vector<std::array<std::int32_t, 4>> out;
  for (std::size_t e = 0; e < first.alive.size(); ++e)
    for (std::size_t f = 0; first.alive[e] && f < faces.size(); ++f) {
      const std::int32_t beside = first.beside[e * faces.size() + f];
      if (beside >= 0 && (!also_new || first.alive[static_cast<std::size_t>(beside)])) continue;
      std::array<std::int32_t, 4> face{-1, -1, -1, -1};
      for (std::size_t k = 0; k < faces[f].size(); ++k)
        face[k] = first.corners[e * b.corner_count() + faces[f][k]];
      out.push_back(face);
    }
  return out;
}

}  // namespace

std::vector<std::array<std::int32_t, 4>> faces_of(const MeshStep::Elements& b) {
  return exposed_now(b, true);
}
std::vector<std::array<std::int32_t, 4>> first_faces_of(const MeshStep::Elements& b) {
  return exposed_now(b, false);
}

bool MeshStep::erode() {
  bool any = false;
  for (auto& body : bodies_) {
    if (!body->erodes()) continue;
    lose_heat(*body);
    const std::vector<Gone> gone = find_eroded(*body);
    if (gone.empty()) continue;
    take_out(*body, gone, domain_.frame == Frame::axisymmetric, audit_);
    any = true;
  }
  if (!any) return false;
  ++shape_changes_;
  make_chunks();
  return true;
}

/// Heat of nodes that eroded elements would have had.
void MeshStep::lose_heat(const Elements& b) {
  if (b.eroded.all() == 0) return;
  for (std::size_t n = 0; n < b.node_count; ++n)
    audit_.removed_energy += b.orphaned[n] * b.nodes.data()[kNode * n + 7];
}

Eroded MeshStep::taken_out(bool converted) const {
  Eroded sum;
  for (const auto& b : bodies_)
    for (const auto part : Eroded::parts)
      if (b->converts() == converted) sum.*part += b->eroded.*part;
  return sum;
}

Eroded MeshStep::eroded() const { return taken_out(false); }
Eroded MeshStep::converted() const { return taken_out(true); }

namespace {

std::string describe(const Eroded& eroded, const char* what) {
  std::string causes;
  for (std::size_t k = 0; k < Eroded::parts.size(); ++k)
    if (const double count = eroded.*Eroded::parts[k]; count > 0)
      causes += fmt::format("{}{:.0f} by {}", causes.empty() ? "" : ", ", count, Eroded::names[k]);
  return fmt::format("{:.0f} elements {}, as the scene asks: {}", eroded.all(), what, causes);
}

}  // namespace

std::string describe_eroded(const Eroded& eroded) { return describe(eroded, "were eroded"); }
std::string describe_converted(const Eroded& converted) {
  return describe(converted, "became points");
}

bool MeshStep::set_count(int s, std::size_t elements) {
  Elements& b = *bodies_[static_cast<std::size_t>(s)];
  const auto now = static_cast<std::size_t>(b.elements.count());
  if (elements == now) return true;
  if (elements > now || !b.erodes()) return false;
  b.elements.truncate(static_cast<int>(elements));
  b.made_of.mesh.elements.resize(elements * b.corner_count());
  make_chunks();
  return true;
}

void find_again(MeshStep::Elements& b) {
  const std::size_t corners = b.corner_count();
  b.first.alive.assign(b.first.alive.size(), false);
  for (int i = 0; i < b.elements.count(); ++i) {
    const auto id = static_cast<std::size_t>(b.elements.at(b.columns.id, i));
    b.first.alive[id] = true;
    for (std::size_t I = 0; I < corners; ++I) {
      const std::size_t lane = (static_cast<std::size_t>(i / kLanes) * corners + I) * kLanes +
                               static_cast<std::size_t>(i % kLanes);
      b.made_of.mesh.elements[static_cast<std::size_t>(i) * corners + I] = b.corners[lane] =
          b.first.corners[id * corners + I];
      b.shares.data()[lane] = b.first.shares[id * corners + I];
    }
  }
  find_nodes_again(b);
}

}  // namespace krater
