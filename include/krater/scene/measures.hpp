// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/measures.hpp
/// What a scene may measure: one registry of kinds, which the reader, the evaluation (measure/)
/// and the documentation (src/output/README.md) follow. A measure is a selection of points and a
/// kind: any kind can be asked of a body, of its largest piece, or of what lies in a region.
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "krater/contact/options.hpp"

namespace krater {

enum class MeasureKind {
  extent,
  max,
  min,
  diameter,
  largest_diameter,
  mean_velocity,
  momentum,
  deceleration,
  settling_time,
  kinetic_energy,
  internal_energy,
  mass,
  removed_mass,
  failed_mass,
  mass_lost,
  mean,
  maximum,
  minimum,
  penetration_depth,
  crater_depth,
  crater_diameter,
  hole_diameter,
  debris_extent,
  fragments,
  impulse,
  force,
  angular_momentum,
  obliquity,
  yaw,
  tilt,
  sound_mass,
  bulge
};

struct MeasureKindInfo {
  MeasureKind kind;
  const char* name;
  const char* unit;  ///< SI; "": that of the field
  const char* keys;  ///< required or special keys beside those of every measure, space-separated
  bool selects;      ///< takes `piece`, `least_points`, `region`
  bool whole;       ///< of the largest piece unless told otherwise: splinters would hide the answer
  bool round;       ///< needs a body of revolution or 3d: impossible in plane strain
  bool turns;       ///< needs what may turn: impossible about an axis
  bool in_history;  ///< cheap enough for every row of history unless told otherwise
  const char* meaning;
};

/// All kinds, in the order of the enum.
const std::vector<MeasureKindInfo>& measure_kinds();
const MeasureKindInfo& info(MeasureKind kind);

/// Which points are measured: those of the bodies, in the region, in the piece.
struct MeasureSelection {
  std::vector<int> bodies;     ///< indices in Scene::bodies
  bool largest_piece = false;  ///< of the connected pieces (measure/pieces.hpp) the heaviest ...
  int least_points = 0;        ///< ... or those of at least so many points; 0: all
  /// [grid axis][0 lower, 1 upper] bounds of the position [m].
  std::array<std::array<double, 2>, 3> region = {unbounded, unbounded, unbounded};
  friend bool operator==(const MeasureSelection&, const MeasureSelection&) = default;

  static constexpr std::array<double, 2> unbounded{-std::numeric_limits<double>::infinity(),
                                                   std::numeric_limits<double>::infinity()};
};

/// Share of the mass that carries an extreme of a field unless told otherwise.
inline constexpr double kExtremeShare = 0.001;

enum class Keep { now, largest, smallest };

struct MeasureOptions {
  std::string name, where;
  MeasureKind kind = MeasureKind::extent;
  MeasureSelection selection;
  int axis = -1;             ///< grid axis; of kinds with a face: its normal
  Triple direction{};        ///< where axis is -1: a unit vector along the grid axes
  double at = 0;             ///< diameter: position on the last axis [m] ...
  bool at_from_end = false;  ///< ... counted from the body's lower end at the time of measuring
  std::string field;         ///< mean, maximum, minimum: field name
  int target = -1;           ///< penetration_depth: body with the face
  int side = -1;             ///< of the face: 0 lower, 1 upper
  std::vector<Partner> by;   ///< impulse, force: who pushes
  double level = 0;          ///< crater_diameter: below the original face [m]; largest_diameter:
                             ///< heights up to this from the body's lower end, 0: all
  double mass_share = 1;     ///< debris_extent: that it holds; maximum, minimum: beyond the value
  Keep keep = Keep::now;     ///< value: at the time of measuring, or the extreme so far
  bool in_history = true;
  std::optional<double> reference;        ///< SI
  std::optional<double> reference_error;  ///< half the bar that its source gives [SI]
  std::string reference_source;
};

/// A field of frames that no point carries: the number of its piece, made when asked for.
inline constexpr const char* kFragmentField = "fragment";

/// Of the axis, or oblique: a unit vector along the grid axes.
Triple direction_of(const MeasureOptions& measure);

/// SI unit of its value.
const char* unit_of(const MeasureOptions& measure);

}  // namespace krater
