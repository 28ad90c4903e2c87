// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/geometry/solids/csg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace krater {
namespace {

using Operands = std::vector<std::shared_ptr<const Solid>>;

class BooleanSolid final : public Solid {
 public:
  BooleanSolid(Boolean operation, Operands operands)
      : operation_(operation), operands_(std::move(operands)) {}
  BooleanSolid(const BooleanSolid& original, const Affine& map)
      : operation_(original.operation_),
        own_(original.own_.empty() ? original.operands_ : original.own_),
        map_(map * original.map_) {
    for (const auto& s : own_) operands_.push_back(transformed(s, map_));
    if (map_.is_similarity()) {
      before_ = std::make_shared<BooleanSolid>(operation_, own_);
    }
  }

  using Solid::contains;

  void spans(const Line& line, Spans& out) const override {
    Spans other, result;
    operands_.front()->spans(line, out);
    for (std::size_t n = 1; n < operands_.size(); ++n) {
      if (out.empty() && operation_ != Boolean::unite) return;
      operands_[n]->spans(line, other);
      combine(step(), out, other, result);
      out.swap(result);
    }
  }

  bool contains(double x, double y, double z) const override {
    const auto in = [&](const auto& s) { return s->contains(x, y, z); };
    switch (operation_) {
      case Boolean::unite:
        return std::any_of(operands_.begin(), operands_.end(), in);
      case Boolean::intersect:
        return std::all_of(operands_.begin(), operands_.end(), in);
      case Boolean::subtract:
        break;
    }
    return in(operands_.front()) && std::none_of(operands_.begin() + 1, operands_.end(), in);
  }

  Box bounding_box() const override {
    Box box = operands_.front()->bounding_box();
    if (operation_ == Boolean::subtract) return box;
    for (std::size_t n = 1; n < operands_.size(); ++n) {
      const Box other = operands_[n]->bounding_box();
      if (operation_ == Boolean::intersect) {
        box = intersection(box, other);
        continue;
      }
      for (std::size_t a = 0; a < 3; ++a) {
        box.min[a] = std::min(box.min[a], other.min[a]);
        box.max[a] = std::max(box.max[a], other.max[a]);
      }
    }
    return box;
  }

  double support(const Vector3& d) const override {
    double best = operands_.front()->support(d);
    if (operation_ == Boolean::subtract) return best;
    for (std::size_t n = 1; n < operands_.size(); ++n) {
      const double other = operands_[n]->support(d);
      best = operation_ == Boolean::unite ? std::max(best, other) : std::min(best, other);
    }
    return best;
  }

  bool revolved_about(const Line& axis) const override {
    return std::all_of(operands_.begin(), operands_.end(),
                       [&](const auto& s) { return s->revolved_about(axis); });
  }

  std::shared_ptr<const Solid> mapped(const Affine& map) const override {
    return std::make_shared<BooleanSolid>(*this, map);
  }

  const Solid* unmapped(Affine& map) const override {
    map = map_;
    return before_.get();
  }

 private:
  SetOperation step() const {
    switch (operation_) {
      case Boolean::unite:
        return SetOperation::unite;
      case Boolean::intersect:
        return SetOperation::intersect;
      case Boolean::subtract:
        break;
    }
    return SetOperation::subtract;
  }

  Boolean operation_;
  Operands operands_;
  Operands own_;  ///< before `map_`; empty: as `operands_`
  Affine map_;
  std::shared_ptr<const BooleanSolid> before_;
};

/// A solid seen through a map: lines and points are taken back into its own coordinates.
class MappedSolid final : public Solid {
 public:
  MappedSolid(std::shared_ptr<const Solid> solid, const Affine& map)
      : solid_(std::move(solid)), map_(map), back_(map.inverse()) {}

  using Solid::contains;

  void spans(const Line& line, Spans& out) const override {
    solid_->spans({back_.apply(line.origin), back_.turn(line.direction)}, out);
  }

  bool contains(double x, double y, double z) const override {
    const Vector3 p = back_.apply({x, y, z});
    return solid_->contains(p[0], p[1], p[2]);
  }

  double support(const Vector3& d) const override {
    return solid_->support(map_.transpose_turn(d)) + dot(d, map_.shift);
  }

  /// Of its own line, if the map takes circles about that to circles about the given one.
  bool revolved_about(const Line& axis) const override {
    const Line own{back_.apply(axis.origin), back_.turn(axis.direction)};
    if (!solid_->revolved_about(own)) return false;
    const Vector3& d = own.direction;
    const bool mostly_x = std::abs(d[0]) > std::abs(d[1]) && std::abs(d[0]) > std::abs(d[2]);
    const Vector3 u = cross(d, mostly_x ? Vector3{0, 1, 0} : Vector3{1, 0, 0});
    const Vector3 v = cross(d, u);
    const double ratio = std::sqrt(dot(v, v) / dot(u, u));
    const Vector3 lu = map_.turn(u), lv = map_.turn({v[0] / ratio, v[1] / ratio, v[2] / ratio});
    const double size = dot(lu, lu), along = std::sqrt(size * dot(axis.direction, axis.direction));
    return std::abs(dot(lv, lv) - size) <= 1e-12 * size && std::abs(dot(lu, lv)) <= 1e-12 * size &&
           std::abs(dot(lu, axis.direction)) <= 1e-12 * along &&
           std::abs(dot(lv, axis.direction)) <= 1e-12 * along;
  }

  std::optional<VolumeMoments> moments() const override {
    const auto own = solid_->moments();
    if (!own) return std::nullopt;
    return own->mapped(map_);
  }

  std::optional<RoundForm> round_form() const override {
    double factor = 1;
    const auto own = solid_->round_form();
    if (!own || !map_.is_similarity(&factor)) return std::nullopt;
    return own->mapped(map_, factor);
  }

  std::shared_ptr<const Solid> mapped(const Affine& map) const override {
    return std::make_shared<MappedSolid>(solid_, map * map_);
  }

  const Solid* unmapped(Affine& map) const override {
    map = map_;
    return map_.is_similarity() ? solid_.get() : nullptr;
  }

 private:
  std::shared_ptr<const Solid> solid_;
  Affine map_, back_;
};

}  // namespace

std::shared_ptr<const Solid> make_boolean(Boolean operation, Operands operands) {
  if (operands.size() < 2) {
    throw std::invalid_argument("a union, intersection or difference needs two shapes or more");
  }
  for (const auto& s : operands) {
    if (!s) throw std::invalid_argument("an operand is missing");
  }
  return std::make_shared<BooleanSolid>(operation, std::move(operands));
}

std::shared_ptr<const Solid> transformed(std::shared_ptr<const Solid> solid, const Affine& map) {
  const double d = map.determinant();
  if (!(std::abs(d) > 0) || !std::isfinite(d)) {
    throw std::invalid_argument("the map of a shape is singular");
  }
  if (auto image = solid->mapped(map)) return image;
  return std::make_shared<MappedSolid>(std::move(solid), map);
}

}  // namespace krater
