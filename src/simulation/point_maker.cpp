// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/simulation/point_maker.hpp"

#include <cmath>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/points/load_fields.hpp"

namespace krater {

PointMaker::PointMaker(const Scene& scene, int body, const Body& of)
    : scene_{scene},
      options_{of.options()},
      slots_{.id = of.slot(field::Id::info),
             .mass = of.slot(field::Mass::info),
             .position = of.slot(field::Position::info),
             .reference = of.slot(field::ReferencePosition::info),
             .configuration = of.slot(field::ConfigurationPosition::info),
             .map = of.slot(field::ConfigurationMap::info),
             .velocity = of.slot(field::Velocity::info),
             .grid_velocity = of.slot(field::GridVelocity::info),
             .affine = of.slot(field::AffineVelocity::info),
             .half_width = of.slot(field::HalfWidth::info),
             .domain = of.slot(field::Domain::info),
             .load_share = of.slot(field::LoadShare::info),
             .deformation = of.slot(field::DeformationGradient::info)},
      density_{of.material().density},
      loads_{loads_of(scene, body)},
      blank_(static_cast<std::size_t>(of.layout().stride() / kLanes), 0.0) {
  for (const Column& c : of.layout().columns())
    for (int k = 0; k < c.components; ++k)
      blank_[static_cast<std::size_t>(c.offset / kLanes + k)] = c.initial;
}

void PointMaker::set(int slot, int component, double value) {
  if (slot >= 0) record_[static_cast<std::size_t>(slot + component)] = value;
}

void PointMaker::place(const SeedPoint& seed) {
  const int dim = dimension(scene_.frame);
  for (int a = 0; a < dim; ++a) {
    const auto i = static_cast<std::size_t>(a);
    set(slots_.position, a, seed.x[i]);
    set(slots_.reference, a, seed.x[i]);
    set(slots_.configuration, a, seed.x[i]);
    set(slots_.map, (dim + 1) * a, 1.0);
    set(slots_.half_width, a, seed.half_width[i]);
    set(slots_.domain, tensor_axis(scene_.frame, a), seed.half_width[i] * seed.half_width[i]);
  }
}

void PointMaker::move(const SeedPoint& seed) {
  const Triple velocity = options_.velocity ? (*options_.velocity)(seed.x, seed.x, 0) : Triple{};
  if (!std::isfinite(velocity[0] + velocity[1] + velocity[2]))
    throw InputError(fmt::format("{}.velocity is not finite at ({:.6g}, {:.6g}, {:.6g}) m",
                                 options_.where, seed.x[0], seed.x[1], seed.x[2]));
  for (int a = 0; a < dimension(scene_.frame); ++a) {
    set(slots_.velocity, a, velocity[static_cast<std::size_t>(a)]);
    set(slots_.grid_velocity, a, velocity[static_cast<std::size_t>(a)]);
  }
  if (options_.velocity && slots_.affine >= 0) spin(seed);
}

void PointMaker::set_motion(std::vector<double>& record, const SeedPoint& whole, double share) {
  SeedPoint part = whole;
  for (int a = 0; a < dimension(scene_.frame); ++a) {
    const auto i = static_cast<std::size_t>(a);
    part.x[i] = record[static_cast<std::size_t>(slots_.position + a)];
    part.half_width[i] *= share;
  }
  record_.swap(record);
  move(part);
  record_.swap(record);
}

/// The affine part holds part of a spinning body's angular momentum and energy: differences over
/// the point's own domain, exact for a linear field.
void PointMaker::spin(const SeedPoint& seed) {
  const int dim = dimension(scene_.frame);
  for (int a = 0; a < dim; ++a) {
    const auto i = static_cast<std::size_t>(a);
    Triple low = seed.x, high = seed.x;
    low[i] -= seed.half_width[i];
    high[i] += seed.half_width[i];
    const Triple before = (*options_.velocity)(low, low, 0);
    const Triple after = (*options_.velocity)(high, high, 0);
    for (int k = 0; k < dim; ++k) {
      const auto j = static_cast<std::size_t>(k);
      set(slots_.affine, dim * k + a, (after[j] - before[j]) / (high[i] - low[i]));
    }
  }
}

std::vector<double>& PointMaker::make(const SeedPoint& seed, std::size_t id) {
  record_ = blank_;
  set(slots_.id, 0, static_cast<double>(id));
  set(slots_.mass, 0, density_ * seed.measure);
  place(seed);
  move(seed);
  for (std::size_t k = 0; k < loads_.size(); ++k)
    set(slots_.load_share, static_cast<int>(k),
        face_share(scene_, scene_.loads.faces[static_cast<std::size_t>(loads_[k])], options_,
                   seed.x));
  for (int k = 0; k < 9; k += 4) set(slots_.deformation, k, 1.0);
  return record_;
}

}  // namespace krater
