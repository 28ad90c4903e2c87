// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file measure/point_layers.hpp
/// The points of bodies of a simulation for measures of their surface, which look at layers: only
/// those are gathered, from the patches that reach into them. Where patches end is known from the
/// walk for the totals of the row (simulation/totals.hpp).
#include <deque>
#include <vector>

#include "krater/measure/measures.hpp"
#include "krater/simulation/simulation.hpp"

namespace krater {

/// Whether a measure looks at the surface by layers along an axis.
bool looks_at_layers(const MeasureOptions& measure);

class PointLayers final : public LayerSource {
 public:
  /// Bodies of material points among cells of one size, which are worth it: of fewer points all
  /// are gathered sooner than other threads wake for each layer.
  static bool should_gather(const Simulation& sim, const std::vector<int>& bodies);
  static constexpr std::size_t kFew = 16384;  ///< points

  /// For a row: the points have moved. `survey`: of the present state. Both must outlive the row.
  void begin(const Simulation& sim, const std::vector<int>& bodies,
             const std::vector<PointSurvey>& survey);
  void release() { layers_.clear(); }  ///< memory of rows before
  /// Where all points are, and the sparse ones.
  SurfaceMemo::Bounds bounds(const MeasureContext& context);

  const BodyPoints& between(int axis, double low, double high) override;
  const BodyPoints& all() override;

 private:
  struct Slots {
    int x, mass, density;
  };
  /// Points of a set from `low` to `high`.
  struct Part {
    std::size_t set, count, first;  ///< set: its place in sets_
    PointBounds bounds{};           ///< of these points
  };
  struct Layer {
    int axis = 0;
    double low = 0, high = 0;
    BodyPoints points;
  };
  struct Set {
    int number;
    Slots slots;
    PointBounds bounds;
  };
  Layer& next(int axis, double low, double high);
  void gather(std::vector<Part> parts, Layer& layer) const;
  std::size_t count_between(const Set& set, const Layer& layer) const;
  void copy_between(Part& part, const Layer& layer, BodyPoints& to) const;

  const Simulation* sim_ = nullptr;
  std::vector<Set> sets_;
  std::size_t used_ = 0;
  std::deque<Layer> layers_;  // references stay valid; memory is kept from row to row
};

}  // namespace krater
