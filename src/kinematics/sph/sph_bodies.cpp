// SPDX-License-Identifier: GPL-3.0-or-later
// How a body of particles is put together.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kinematics/sph/particles.hpp"
#include "krater/kinematics/sph/sph_loads.hpp"
#include "krater/points/load_fields.hpp"

namespace krater {

namespace {

constexpr const char* kMethod = "particles";
constexpr int kChunkGroups = 32;  ///< lane groups that one thread takes at once
constexpr double kSkin = 0.15;    ///< of lists, in h

SphColumns columns_of(const Layout& layout) {
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
          .share = state(field::LoadShare{}),
          .local_gradient = local(field::StepGradient{}),
          .local_rate = local(field::DilatationRate{}),
          .local_shear = local(field::ShearModulus{}),
          .stride = layout.stride(),
          .local_stride = layout.local_stride()};
}

/// Near ones near in memory.
void sort_points(const PointStore& given, int dim, SphStep::Particles& body) {
  std::vector<std::array<double, 3>> places(static_cast<std::size_t>(given.count()));
  for (int i = 0; i < given.count(); ++i)
    for (int a = 0; a < dim; ++a)
      places[static_cast<std::size_t>(i)][static_cast<std::size_t>(a)] =
          given.at(body.columns.position + kLanes * a, i);
  body.points = PointStore{given.stride()};
  std::vector<double> record;
  for (const std::uint32_t i : order_along_curve(places, 2 * body.made_of.options.length())) {
    record.clear();
    given.copy_out(static_cast<int>(i), record);
    body.points.append(record.data());
  }
  body.points.pad(body.columns.mass);
}

void make_room(int dim, SphStep::Particles& body) {
  const std::size_t groups = body.group_count();
  body.correction.reserve(6 * groups * kLanes);
  body.power.reserve(groups * kLanes);
  body.force.reserve(3 * groups * kLanes);
  body.held.reserve(4 * groups * kLanes);
  body.remembered.reserve(2 * groups * kLanes);
  body.changes.reserve(kSphChange * groups * kLanes);
  body.reference.reserve(3 * groups * kLanes);
  body.reference_density.reserve(groups * kLanes);
  body.deformation.reserve(body.fixed() ? 9 * groups * kLanes : 0);
  std::fill_n(body.reference_density.data(), groups * kLanes, body.made_of.density);
  for (std::size_t g = 0; g < groups; ++g) {
    std::fill_n(body.remembered.data() + 2 * g * kLanes, kLanes, body.made_of.shear_modulus);
    for (std::size_t k = 0; k < 9 && body.fixed(); k += 4)
      std::fill_n(body.deformation.data() + (9 * g + k) * kLanes, kLanes, 1.0);
    for (int l = 0; l < kLanes; ++l)
      for (int a = 0; a < dim; ++a)
        body.reference
            .data()[(3 * g + static_cast<std::size_t>(a)) * kLanes + static_cast<std::size_t>(l)] =
            body.points.at(body.columns.position + kLanes * a, kLanes * static_cast<int>(g) + l);
  }
  if (!body.adaptive()) return;
  body.first.reserve(3 * groups * kLanes);
  std::copy_n(body.reference.data(), 3 * groups * kLanes, body.first.data());
}

}  // namespace

void declare_particles(double density, bool face_loads, Layout& layout) {
  layout.state<field::Id>(0, kMethod);
  layout.state<field::Position>(0, kMethod);
  layout.state<field::Velocity>(0, kMethod);
  layout.state<field::Mass>(0, kMethod);
  layout.state<field::Density>(density, kMethod);
  if (face_loads) layout.state<field::LoadShare>(0, kMethod);
  layout.local_output<field::StepGradient>(kMethod);
}

void declare_particle_results(Layout& layout) {
  if (layout.optional<field::InternalEnergy>().offset < 0)
    layout.state<field::InternalEnergy>(0, kMethod);
  layout.local_input<field::DilatationRate>(kMethod);
}

SphStep::SphStep(const DomainSides& domain, IsaLevel level, Audit& audit)
    : domain_{domain},
      dim_{dimension(domain.frame)},
      level_{level},
      pushing_{pushing_sides(domain)},
      audit_{audit},
      loads_{std::make_unique<SphLoads>(LoadOptions{}, Acceleration{}, dimension(domain.frame))} {
  if (domain.frame == Frame::axisymmetric)
    throw std::invalid_argument("particles in axial symmetry");
}

SphStep::~SphStep() = default;

void SphStep::set_loads(std::unique_ptr<SphLoads> loads) { loads_ = std::move(loads); }

void SphStep::set_time(double time) {
  loads_->set_time(time);
  for (PushingSide& side : pushing_) side.set_time(time);
}

void SphStep::add(SphBody made_of) {
  auto body = std::make_unique<Particles>();
  body->made_of = std::move(made_of);
  SphBody& m = body->made_of;
  const SphOptions& options = m.options;
  body->columns = columns_of(*m.layout);
  body->kernels.reset(sph_kernel_factory(level_).make({dim_, options.kernel, options.reference}));
  sort_points(m.points, dim_, *body);
  m.points = {};
  make_room(dim_, *body);
  std::vector<Neighbours::Plane> planes;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
    for (std::size_t s = 0; s < 2; ++s)
      if (domain_.sides[a][s].kind == BoundaryKind::symmetry)
        planes.push_back({a, domain_.planes[a][s], s == 0 ? 1.0 : -1.0, 0});
  body->neighbours = Neighbours{dim_, 2 * options.length(),
                                body->fixed() ? 0 : kSkin * options.length(), std::move(planes)};
  for (const PushingSide& side : pushing_) {
    std::vector<double>& standoff = body->standoff.emplace_back();
    for (int i = 0; i < body->points.count(); ++i) {
      const double x =
          body->points.at(body->columns.position + kLanes * static_cast<int>(side.axis), i);
      standoff.push_back(std::min(options.spacing / 2, side.inwards * (x - side.plane)));
    }
  }
  for (int first = 0; first < body->points.groups(); first += kChunkGroups)
    chunks_.push_back(
        {bodies_.size(), first, std::min(first + kChunkGroups, body->points.groups())});
  bodies_.push_back(std::move(body));
}

}  // namespace krater
