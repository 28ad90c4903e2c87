// SPDX-License-Identifier: GPL-3.0-or-later
// How a body of elements is put together.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "kinematics/mesh/elements.hpp"
#include "krater/core/errors.hpp"
#include "krater/kinematics/mesh/mesh_loads.hpp"

namespace krater {

namespace {

constexpr const char* kMethod = "elements";
constexpr int kChunkGroups = 32;  ///< lane groups that one thread takes at once

ElementColumns columns_of(const Layout& layout) {
  const auto state = [&]<class F>(F) { return layout.optional<F>().offset; };
  const auto local = [&]<class F>(F) { return layout.local_optional<F>().offset; };
  return {.id = state(field::Id{}),
          .position = state(field::Position{}),
          .velocity = state(field::Velocity{}),
          .mass = state(field::Mass{}),
          .density = state(field::Density{}),
          .stress = state(field::DeviatoricStress{}),
          .pressure = state(field::Pressure{}),
          .viscous = state(field::ViscousPressure{}),
          .energy = state(field::InternalEnergy{}),
          .sound_speed = state(field::SoundSpeed{}),
          .plastic = state(field::PlasticStrain{}),
          .failed = state(field::Failed{}),
          .local_gradient = local(field::StepGradient{}),
          .local_extra = local(field::ExtraDilatation{}),
          .local_rate = local(field::DilatationRate{}),
          .local_shear = local(field::ShearModulus{}),
          .stride = layout.stride(),
          .local_stride = layout.local_stride()};
}

/// One element of `share[I]` volumes as a record of its columns.
void fill_record(const ElementBody& made_of, const ElementColumns& c, std::size_t element,
                 const double* share, std::vector<double>& record) {
  const Mesh& mesh = made_of.mesh;
  const auto corners = static_cast<std::size_t>(mesh.corners());
  double volume = 0;
  Triple centre{};
  for (std::size_t I = 0; I < corners; ++I) {
    const auto n = static_cast<std::size_t>(mesh.elements[element * corners + I]);
    volume += share[I];
    for (std::size_t a = 0; a < 3; ++a) centre[a] += mesh.nodes[n][a] / mesh.corners();
    if (!(share[I] > 0))
      throw InputError(
          fmt::format("element {} is inverted or has no volume at its corner {}", element, I));
  }
  record.assign(static_cast<std::size_t>(made_of.layout->stride() / kLanes), 0.0);
  const auto put = [&](int offset, double value) {
    record[static_cast<std::size_t>(offset / kLanes)] = value;
  };
  for (const Column& column : made_of.layout->columns())
    for (int k = 0; k < column.components; ++k) put(column.offset + kLanes * k, column.initial);
  put(c.id, static_cast<double>(element));
  put(c.mass, made_of.density * volume);
  for (int a = 0; a < mesh.dimension; ++a)
    put(c.position + kLanes * a, centre[static_cast<std::size_t>(a)]);
  if (const Column* X = made_of.layout->find(field::ReferencePosition::info.name))
    for (int a = 0; a < mesh.dimension; ++a)
      put(X->offset + kLanes * a, centre[static_cast<std::size_t>(a)]);
  if (const Column* F = made_of.layout->find(field::DeformationGradient::info.name))
    for (int k = 0; k < 9; k += 4) put(F->offset + kLanes * k, 1.0);
}

/// References, where elements keep one: the start.
void place_references(MeshStep::Elements& body) {
  const Mesh& mesh = body.made_of.mesh;
  const std::size_t rows = body.placed_rows(), dim = static_cast<std::size_t>(mesh.dimension),
                    lanes = static_cast<std::size_t>(body.elements.groups()) * kLanes;
  body.placed.reserve(rows * lanes);
  for (std::size_t i = 0; i < lanes && rows > 0; ++i) {
    double* to = body.placed.data() + i / kLanes * rows * kLanes + i % kLanes;
    for (std::size_t I = 0; I < body.corner_count(); ++I) {
      const auto n = static_cast<std::size_t>(
          body.corners[(i / kLanes * body.corner_count() + I) * kLanes + i % kLanes]);
      for (std::size_t a = 0; a < dim; ++a) to[(dim * I + a) * kLanes] = mesh.nodes[n][a];
    }
    to[(rows - 1) * kLanes] = 1;
  }
}

/// What is sorted by lanes; padding repeats the last element.
void sort_by_lanes(const std::vector<double>& volumes, MeshStep::Elements& body) {
  const Mesh& mesh = body.made_of.mesh;
  const std::size_t corners = body.corner_count(), count = mesh.element_count(),
                    groups = static_cast<std::size_t>(body.elements.groups()),
                    dim = static_cast<std::size_t>(mesh.dimension);
  body.corners.resize(groups * corners * kLanes);
  body.shares.reserve(groups * corners * kLanes);
  for (std::size_t g = 0; g < groups; ++g)
    for (std::size_t I = 0; I < corners; ++I)
      for (std::size_t l = 0; l < kLanes; ++l) {
        const std::size_t from = std::min(g * kLanes + l, count - 1) * corners + I,
                          to = (g * corners + I) * kLanes + l;
        body.corners[to] = mesh.elements[from];
        body.shares.data()[to] = body.made_of.density * volumes[from];
      }
  place_references(body);
  body.forces.reserve(groups * corners *
                      static_cast<std::size_t>(dim == 3 ? kForceDoubles<3> : kForceDoubles<2>) *
                      kLanes);
  body.hourglass.reserve(groups * (dim == 3 ? 12 : 2) * kLanes);
  body.hourglass_energy.reserve(groups * kLanes);
  body.remembered.reserve(groups * kRemembered * kLanes);
  for (std::size_t g = 0; g < groups; ++g)
    std::fill_n(body.remembered.data() + kRemembered * g * kLanes, kLanes,
                body.made_of.shear_modulus);
}

void place_nodes(const std::vector<double>& volumes, MeshStep::Elements& body) {
  const ElementBody& made_of = body.made_of;
  body.node_count = made_of.mesh.nodes.size();
  body.nodes.reserve(kNode * body.node_count);
  body.changes.reserve(kChange * body.node_count);
  for (std::size_t n = 0; n < body.node_count; ++n) {
    double* node = body.node(n);
    for (std::size_t a = 0; a < static_cast<std::size_t>(made_of.mesh.dimension); ++a) {
      node[a] = made_of.mesh.nodes[n][a];
      node[4 + a] = made_of.velocities.empty() ? 0 : made_of.velocities[n][a];
    }
    for (std::size_t p = body.corners_of.first[n]; p < body.corners_of.first[n + 1]; ++p)
      node[3] += made_of.density * volumes[body.corners_of.places[p]];
    if (!(node[3] > 0)) throw InputError(fmt::format("node {} belongs to no element", n));
  }
}

/// Of the elements at the start: the mean of their corners by mass, as every step gives it.
void find_velocities(MeshStep::Elements& body) {
  const std::size_t corners = body.corner_count();
  for (int e = 0; e < body.elements.count(); ++e)
    for (int a = 0; a < body.made_of.mesh.dimension; ++a) {
      double momentum = 0, mass = 0;
      for (std::size_t I = 0; I < corners; ++I) {
        const std::size_t group = static_cast<std::size_t>(e / kLanes),
                          at =
                              (group * corners + I) * kLanes + static_cast<std::size_t>(e % kLanes);
        mass += body.shares.data()[at];
        momentum +=
            body.shares.data()[at] *
            body.node(static_cast<std::size_t>(body.corners[at]))[4 + static_cast<std::size_t>(a)];
      }
      body.elements.at(body.columns.velocity + kLanes * a, e) = momentum / mass;
    }
  body.elements.pad(body.columns.mass);
}

}  // namespace

void declare_elements(double density, Layout& layout) {
  layout.state<field::Id>(0, kMethod);
  layout.state<field::Position>(0, kMethod);
  layout.state<field::Velocity>(0, kMethod);
  layout.state<field::Mass>(0, kMethod);
  layout.state<field::Density>(density, kMethod);
  layout.local_output<field::StepGradient>(kMethod);
  layout.local_output<field::ExtraDilatation>(kMethod);
}

void declare_element_results(Layout& layout) {
  if (layout.optional<field::InternalEnergy>().offset < 0)
    layout.state<field::InternalEnergy>(0, kMethod);
  layout.local_input<field::DilatationRate>(kMethod);
}

MeshStep::MeshStep(const DomainSides& domain, const MeshKernels& kernels, Audit& audit)
    : domain_{domain},
      dim_{dimension(domain.frame)},
      pushing_{pushing_sides(domain)},
      kernels_{kernels},
      audit_{audit},
      loads_{std::make_unique<MeshLoads>(LoadOptions{}, Acceleration{}, domain.frame)} {}

MeshStep::~MeshStep() = default;

void MeshStep::set_impulses(Impulses& impulses, bool apart) {
  impulses_ = &impulses;
  apart_ = apart;
}

void MeshStep::add(ElementBody made_of) {
  auto body = std::make_unique<Elements>();
  body->made_of = std::move(made_of);
  const ElementBody& m = body->made_of;
  body->columns = columns_of(*m.layout);
  body->corners_of = node_corners(m.mesh);
  const std::vector<double> volumes = corner_volumes(m.mesh, domain_.frame == Frame::axisymmetric);
  body->elements = PointStore{m.layout->stride()};
  std::vector<double> record;
  for (std::size_t e = 0; e < m.mesh.element_count(); ++e) {
    fill_record(m, body->columns, e, volumes.data() + e * body->corner_count(), record);
    body->elements.append(record.data());
  }
  body->elements.pad(body->columns.mass);
  sort_by_lanes(volumes, *body);
  place_nodes(volumes, *body);
  note_planes(*body);
  find_velocities(*body);
  if (body->erodes()) {
    body->first = find_neighbours(m.mesh);
    for (const double volume : volumes) body->first.shares.push_back(m.density * volume);
    body->orphaned.assign(body->node_count, 0.0);
  }
  bodies_.push_back(std::move(body));
  make_chunks();
}

void MeshStep::make_chunks() {
  chunks_.clear();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const int groups = bodies_[b]->elements.groups();
    for (int first = 0; first < groups; first += kChunkGroups)
      chunks_.push_back({b, first, std::min(first + kChunkGroups, groups)});
  }
}

std::vector<std::array<std::int32_t, 4>> MeshStep::meeting_faces(int s) const {
  const Elements& body = *bodies_[static_cast<std::size_t>(s)];
  std::vector<std::array<std::int32_t, 4>> out;
  for (const auto& face : faces_of(body)) {
    unsigned planes = ~0U;
    for (const std::int32_t n : face)
      if (n >= 0) planes &= body.on_plane[static_cast<std::size_t>(n)];
    if (planes == 0) out.push_back(face);
  }
  for (std::size_t n = 0; body.erodes() && !body.converts() && n < body.node_count; ++n)
    if (body.corners_of.first[n] == body.corners_of.first[n + 1])
      out.push_back({static_cast<std::int32_t>(n), -1, -1, -1});
  return out;
}

/// Nodes that lie on a plane that holds them, and their start.
void MeshStep::note_planes(Elements& body) const {
  body.on_plane.assign(body.node_count, 0);
  double size = 0;
  for (std::size_t n = 0; n < body.node_count; ++n)
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
      size = std::max(size, std::abs(body.node(n)[a]));
  for (std::size_t n = 0; n < body.node_count; ++n)
    for (unsigned a = 0; a < static_cast<unsigned>(dim_); ++a)
      for (unsigned side = 0; side < 2; ++side) {
        const bool axis = domain_.frame == Frame::axisymmetric && a == 0 && side == 0;
        if (domain_.sides[a][side].kind != BoundaryKind::symmetry && !axis) continue;
        if (std::abs(body.node(n)[a] - domain_.planes[a][side]) > 1e-12 * size) continue;
        body.on_plane[n] = static_cast<std::uint8_t>(body.on_plane[n] | (1U << a));
        body.node(n)[4 + a] = 0;
      }
}

}  // namespace krater
