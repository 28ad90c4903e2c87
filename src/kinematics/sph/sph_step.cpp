// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/sph/sph_step.hpp"

#include <algorithm>

#include "kinematics/sph/particles.hpp"
#include "krater/core/parallel.hpp"
#include "krater/kinematics/sph/sph_loads.hpp"
#include "krater/kinematics/sweep_account.hpp"

namespace krater {

SphData SphStep::data(Particles& b) const {
  return {.particles = b.points.data(),
          .count = b.points.count(),
          .groups = b.points.groups(),
          .neighbours = b.neighbours.rows(),
          .motion = b.motion.data(),
          .load = b.load.data(),
          .correction = b.correction.data(),
          .power = b.power.data(),
          .force = b.force.data(),
          .held = b.held.data(),
          .remembered = b.remembered.data(),
          .reference = b.reference.data(),
          .reference_density = b.reference_density.data(),
          .deformation = b.deformation.data(),
          .changes = b.changes.data(),
          .columns = b.columns,
          .stages = b.made_of.stages,
          .stage_count = b.made_of.stage_count,
          .h = b.made_of.options.length(),
          .q_lin = b.made_of.q_lin,
          .q_quad = b.made_of.q_quad,
          .zero_energy = b.made_of.options.zero_energy,
          .artificial_stress = b.fixed() ? 0 : b.made_of.options.artificial_stress,
          .spacing = b.made_of.options.spacing,
          .corrects = b.made_of.options.correction == SphCorrection::linear};
}

SphScratch SphStep::scratch() {
  AlignedBuffer& mine = scratch_[static_cast<std::size_t>(thread_index())];
  double* length = mine.data();
  double* zeros = length + kSphGroups * kLanes;
  return {zeros + 9 * kLanes, length, zeros};
}

template <class Work>
void SphStep::over_groups(const Work& work) {
  for_each(chunks_.size(), [&](std::size_t c) {
    Particles& body = *bodies_[chunks_[c].body];
    work(body, data(body), chunks_[c].first, chunks_[c].last, c);
  });
}

void SphStep::start() {
  for (auto& b : bodies_) b->motion.reserve(kMotion * b->group_count() * kLanes);
  over_groups([](Particles& b, const SphData& d, int first, int last, std::size_t) {
    b.kernels->place(d, false, first, last);
  });
  for (auto& b : bodies_) b->neighbours.make(b->motion.data(), b->points.count());
  find_forces();
}

namespace {

double kinetic_of(const SphStep::Particles& b, int dim, int first, int last) {
  double sum = 0;
  for (int i = first; i < last; ++i) {
    double squares = 0;
    for (int a = 0; a < dim; ++a) {
      const double v = b.points.at(b.columns.velocity + kLanes * a, i);
      squares += v * v;
    }
    sum += 0.5 * b.points.at(b.columns.mass, i) * squares;
  }
  return sum;
}

}  // namespace

double SphStep::kinetic_energy(int s) const {
  const Particles& b = *bodies_[static_cast<std::size_t>(s)];
  return kinetic_of(b, dim_, 0, b.points.count());
}

double SphStep::internal_energy(int s) const {
  const Particles& b = *bodies_[static_cast<std::size_t>(s)];
  double sum = 0;
  for (int i = 0; i < b.points.count(); ++i)
    sum += b.points.at(b.columns.mass, i) * b.points.at(b.columns.energy, i);
  return sum;
}

void SphStep::find_limit(const std::vector<SphResult>& results) {
  limit_ = {};
  for (std::size_t c = 0; c < results.size(); ++c) {
    const SphResult& r = results[c];
    if (r.fault.kind != FaultKind::none)
      throw ParticleFault{static_cast<int>(chunks_[c].body), r.fault};
    const Particles& body = *bodies_[chunks_[c].body];
    note_limit(r, body.made_of.body, body.points, body.columns.id, limit_);
  }
}

void SphStep::book(const std::vector<SphResult>& results, const Standing& others) {
  SweepAccount account{audit_, others};
  audit_.kinetic = others.kinetic;
  for (std::size_t c = 0; c < results.size(); ++c) {
    const SphResult& r = results[c];
    account.add(r, r.internal, 0, bodies_[chunks_[c].body]->made_of.barotropic);
    audit_.stabilisation += r.held;
  }
  account.close();
  std::vector<double> kinetic(chunks_.size());
  over_groups([&](Particles& b, const SphData&, int first, int last, std::size_t c) {
    kinetic[c] = kinetic_of(b, dim_, kLanes * first, std::min(kLanes * last, b.points.count()));
  });
  for (const double energy : kinetic) audit_.kinetic += energy;
}

/// Lists are made where the records of motion are, and records have room for the images.
void SphStep::renew_lists() {
  for (auto& b : bodies_) {
    if (!b->fixed() && b->neighbours.stale(b->motion.data()))
      b->neighbours.make(b->motion.data(), b->points.count());
    b->motion.reserve(kMotion * b->neighbours.records());
    b->load.reserve(static_cast<std::size_t>(load_record(dim_).size) * b->neighbours.records());
  }
}

void SphStep::find_forces() {
  over_groups([](Particles& b, const SphData& d, int first, int last, std::size_t) {
    b.kernels->place(d, false, first, last);
  });
  renew_lists();
  for (auto& b : bodies_) b->neighbours.reflect_motion(b->motion.data());
  std::vector<SphResult> results(chunks_.size());
  over_groups([&](Particles& b, const SphData& d, int first, int last, std::size_t c) {
    b.kernels->correct(d, first, last, results[c]);
  });
  for (auto& b : bodies_) {
    b->neighbours.reflect_load(b->load.data());
    b->flat = 0;
  }
  over_groups([](Particles& b, const SphData& d, int first, int last, std::size_t) {
    b.kernels->forces(d, first, last);
  });
  find_limit(results);
  for (std::size_t c = 0; c < chunks_.size(); ++c)
    bodies_[chunks_[c].body]->flat += static_cast<std::size_t>(results[c].flat);
  find_areas();
}

/// X <- x, rho_0 <- rho, F <- 1 of bodies that are strained too far somewhere: columns are not
/// touched.
void SphStep::renew_references(const std::vector<SphResult>& results) {
  for (std::size_t s = 0; s < bodies_.size(); ++s) {
    Particles& b = *bodies_[s];
    double stretch = 0;
    for (std::size_t c = 0; c < results.size(); ++c)
      if (chunks_[c].body == s) stretch = std::max(stretch, results[c].stretch);
    if (!b.adaptive() || !(stretch > 2 * b.made_of.options.refresh_strain)) continue;
    for (int i = 0; i < kLanes * b.points.groups(); ++i) {
      for (int a = 0; a < dim_; ++a)
        b.reference.data()[(3 * (i / kLanes) + a) * kLanes + i % kLanes] =
            b.points.at(b.columns.position + kLanes * a, i);
      b.reference_density.data()[i] = b.points.at(b.columns.density, i);
      for (int k = 0; k < 9; ++k)
        b.deformation.data()[(9 * (i / kLanes) + k) * kLanes + i % kLanes] = k % 4 == 0 ? 1 : 0;
    }
    b.kernels->place(data(b), false, 0, b.points.groups());
    b.neighbours.make(b.motion.data(), b.points.count());
    audit_.new_references += 1;
  }
}

/// Of the bodies that are pressed, by the sweep that sums forces; nothing else reads their records
/// of load from here on.
void SphStep::find_areas() {
  const auto pressed = [&](const Particles& b) { return loads_->presses(b.made_of.body); };
  if (std::none_of(bodies_.begin(), bodies_.end(), [&](const auto& b) { return pressed(*b); }))
    return;
  over_groups([&](Particles& b, const SphData& d, int first, int last, std::size_t) {
    if (pressed(b)) b.kernels->show_unit(d, first, last);
  });
  for (auto& b : bodies_) {
    if (!pressed(*b)) continue;
    b->neighbours.reflect_load(b->load.data());
    b->areas.reserve(7 * b->group_count() * kLanes);
  }
  over_groups([&](Particles& b, SphData d, int first, int last, std::size_t) {
    if (!pressed(b)) return;
    d.zero_energy = d.artificial_stress = 0;
    d.force = b.areas.data();
    d.held = d.force + 3 * kLanes * d.groups;
    b.kernels->forces(d, first, last);
  });
}

Triple SphStep::force_of(int s, int i) const {
  const Particles& b = *bodies_[static_cast<std::size_t>(s)];
  Triple f{};
  for (int a = 0; a < dim_; ++a)
    f[static_cast<std::size_t>(a)] = b.force.data()[(3 * (i / kLanes) + a) * kLanes + i % kLanes];
  return f;
}

double SphStep::power_of(int s, int i) const {
  const Particles& b = *bodies_[static_cast<std::size_t>(s)];
  return b.power.data()[i] * b.points.at(b.columns.mass, i) / b.points.at(b.columns.density, i);
}

double SphStep::force(double dt) {
  over_groups([&](Particles& b, const SphData&, int first, int last, std::size_t) {
    for (int i = kLanes * first; i < std::min(kLanes * last, b.points.count()); ++i) {
      const double per_mass = dt / b.points.at(b.columns.mass, i);
      double* change = b.change(i);
      const double* f = b.force.data() + 3 * (i / kLanes) * kLanes + i % kLanes;
      for (int a = 0; a < dim_; ++a) change[a] = per_mass * f[a * kLanes];
      change[3] = 0;
    }
  });
  for (auto& b : bodies_) loads_->add(*b, dt);
  return dt;
}

/// Planes of symmetry are booked as what all but them leaves (push_from_sides).
void SphStep::book_loads() {
  for (auto& b : bodies_) {
    const Triple given = loads_->book(*b, audit_);
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim_); ++a)
      if (mirrored(a)) audit_.wall_impulse[a] -= given[a];
  }
}

void SphStep::push_from_sides(Particles& b, int first, int last, double dt, SideSums& sums) const {
  const auto dim = static_cast<std::size_t>(dim_);
  for (int i = first; i < last; ++i) {
    double* change = b.change(i);
    const Triple x = b.vector(b.columns.position, i, dim_),
                 before = b.vector(b.columns.velocity, i, dim_);
    const double mass = b.points.at(b.columns.mass, i);
    Triple v = before, all{};
    for (std::size_t a = 0; a < dim; ++a) {
      if (mirrored(a))
        sums.impulse[a] += mass * change[a];  // of the images: all else is between particles
      v[a] += change[a];
    }
    bool pushed = false;
    double given = 0;  // work of sides that move, per mass
    for (std::size_t s = 0; s < pushing_.size(); ++s) {
      const double missing =
          pushing_[s].missing(x, v, b.standoff[s][static_cast<std::size_t>(i)], dt);
      if (!(missing > 0)) continue;
      pushed = true;
      const Triple push = pushing_[s].push(v, missing, dim_);
      for (std::size_t a = 0; a < dim; ++a) {
        v[a] += push[a];
        all[a] += push[a];
        given += push[a] * pushing_[s].velocity[a];
      }
    }
    if (!pushed) continue;
    for (std::size_t a = 0; a < dim; ++a) {
      change[a] += all[a];
      change[3] -= all[a] * (before[a] + 0.5 * change[a]);
      sums.impulse[a] += mass * all[a];
    }
    change[3] += given;
    sums.work += mass * given;
    sums.heat += mass * change[3];
  }
}

void SphStep::meet(double dt) {
  std::vector<SideSums> sums(chunks_.size());
  over_groups([&](Particles& b, const SphData&, int first, int last, std::size_t c) {
    push_from_sides(b, kLanes * first, std::min(kLanes * last, b.points.count()), dt, sums[c]);
  });
  for (const SideSums& s : sums) {
    audit_.wall_heat += s.heat;
    audit_.wall_work += s.work;
    for (std::size_t a = 0; a < 3; ++a) audit_.wall_impulse[a] += s.impulse[a];
  }
}

Standing SphStep::move(double dt, const Standing& others) {
  book_loads();
  over_groups([](Particles& b, const SphData& d, int first, int last, std::size_t) {
    b.kernels->place(d, true, first, last);
  });
  for (auto& b : bodies_) b->neighbours.reflect_motion(b->motion.data());
  int most = 0;
  for (const auto& b : bodies_) most = std::max(most, b->columns.local_stride);
  scratch_.resize(static_cast<std::size_t>(threads()));
  for (AlignedBuffer& buffer : scratch_)
    buffer.reserve(kSphGroups * (kLanes + static_cast<std::size_t>(most)) + 9 * kLanes);
  std::vector<SphResult> results(chunks_.size());
  over_groups([&](Particles& b, const SphData& d, int first, int last, std::size_t c) {
    b.kernels->strain(d, scratch(), dt, first, last, results[c]);
  });
  find_limit(results);  // or the fault
  book(results, others);
  renew_references(results);
  find_forces();
  audit_.contact_pairs = others.contact_pairs;
  return {audit_.kinetic, audit_.internal, audit_.unfelt, audit_.law_lead, audit_.contact_pairs};
}

std::vector<double> SphStep::state(int s) const {
  const Particles& b = *bodies_[static_cast<std::size_t>(s)];
  const std::size_t lanes = b.group_count() * kLanes;
  std::vector<double> out = b.neighbours.places();
  out.insert(out.end(), b.remembered.data(), b.remembered.data() + 2 * lanes);
  if (!b.fixed()) return out;
  out.insert(out.end(), b.deformation.data(), b.deformation.data() + 9 * lanes);
  out.insert(out.end(), b.reference_density.data(), b.reference_density.data() + lanes);
  return out;
}

bool SphStep::set_state(int s, const std::vector<double>& state) {
  Particles& b = *bodies_[static_cast<std::size_t>(s)];
  const std::size_t lanes = b.group_count() * kLanes, places = b.neighbours.places().size();
  if (state.size() != places + (b.fixed() ? 12 : 2) * lanes) return false;
  b.neighbours.make_from(state.data(), b.points.count());
  std::copy_n(state.data() + places, 2 * lanes, b.remembered.data());
  if (!b.fixed()) return true;
  std::copy_n(state.data() + places + 2 * lanes, 9 * lanes, b.deformation.data());
  std::copy_n(state.data() + places + 11 * lanes, lanes, b.reference_density.data());
  for (int i = 0; i < b.points.count(); ++i)
    for (int a = 0; a < dim_; ++a)
      b.reference.data()[(3 * (i / kLanes) + a) * kLanes + i % kLanes] =
          state[3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(a)];
  return true;
}

void SphStep::pad(int s) {
  Particles& b = *bodies_[static_cast<std::size_t>(s)];
  b.points.pad(b.columns.mass);
}

std::size_t SphStep::memory() const {
  std::size_t bytes = 0;
  for (const auto& b : bodies_) {
    for (const AlignedBuffer* buffer :
         {&b->motion, &b->load, &b->correction, &b->power, &b->force, &b->held, &b->remembered,
          &b->reference, &b->deformation, &b->changes, &b->areas})
      bytes += 8 * buffer->size();
    bytes += 8 * b->points.capacity() + b->neighbours.memory();
  }
  return bytes;
}

std::size_t SphStep::flat_count() const {
  std::size_t flat = 0;
  for (const auto& b : bodies_) flat += b->flat;
  return flat;
}

SphHealth SphStep::health() const {
  SphHealth out{.flat = flat_count()};
  for (const auto& b : bodies_) {
    const auto count = static_cast<std::size_t>(b->points.count());
    out.particles += count;
    out.images += b->neighbours.image_count();
    out.neighbours += static_cast<double>(count) * b->neighbours.mean_count();
    out.lists += b->neighbours.made();
  }
  out.neighbours /= static_cast<double>(std::max<std::size_t>(1, out.particles));
  return out;
}

PointSet SphStep::set(int s) const {
  const Particles& b = *bodies_[static_cast<std::size_t>(s)];
  return {b.made_of.body, &b.points};
}
PointStore& SphStep::change(int s) { return bodies_[static_cast<std::size_t>(s)]->points; }

}  // namespace krater
