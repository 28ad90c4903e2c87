// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file point_driver/loading_path.hpp
/// The steps of a loading path, and mixed control: where the path prescribes a stress, the stretch
/// of the step that brings it about is found by Newton's method (secants; bisection where they
/// leave the bracket), the state taken back between trials.
#include <string>
#include <vector>

#include <Eigen/Core>

#include "krater/point_driver/material_point.hpp"
#include "krater/scene/point.hpp"

namespace krater {

/// What a step does not prescribe, and what it prescribes instead.
enum class Control {
  none,            ///< the whole map is given
  lateral_stress,  ///< y and z stretch alike: sigma_yy = target [Pa]
  triaxiality,     ///< the same: mean stress = target 3/2 s_xx
  mean_stress,     ///< x, y and z stretch alike: mean stress = target [Pa]
  normal_stress    ///< z stretches: sigma_zz = target [Pa]
};

struct PathStep {
  double dt = 0;                                  ///< [s]
  Eigen::Matrix3d map = Eigen::Matrix3d::Zero();  ///< f - I, as far as given
  Control control = Control::none;
  double target = 0;
};

/// A path as a sequence of steps, made one at a time.
class LoadingPath {
 public:
  /// `start_pressure` [Pa] and `modulus` [Pa] are those of the point before the first step: a
  /// release starts there, and the time of a step that prescribes a stress follows from them.
  LoadingPath(const PathOptions& path, int steps, double start_pressure, double modulus);
  int steps() const { return steps_; }
  PathStep step(int number) const;

 private:
  enum class Kind { stretch, shear, swell, confine, velocity_gradient, deformation };
  struct Leg {
    Kind kind;
    int first, count;
    double from, to;  ///< strain, shear, compression, mean stress or time
  };
  Kind kind_of_turns() const;
  void add(Kind kind, int count, double from, double to);
  PathStep in_leg(const Leg& leg, double a, double b) const;
  Eigen::Matrix3d tensor(double t) const;

  const PathOptions& path_;
  double modulus_;
  double sign_ = 1;  ///< of the first strain
  int steps_ = 0;
  std::vector<Leg> legs_;
};

/// sym H of a map: the strain of the step (materials/stages/kinematics_stage.hpp).
Eigen::Matrix3d strain_of(const Eigen::Matrix3d& map);

/// Takes a point through prescribed and mixed steps.
class PathDriver {
 public:
  explicit PathDriver(MaterialPoint& point) : point_{point} {}

  /// Returns the map taken. Throws NumericalError (without place) where the update fails or no
  /// stretch gives the stress.
  Eigen::Matrix3d take(const PathStep& step);
  long updates() const { return updates_; }    ///< of the point, trials included
  int trials() const { return trials_; }       ///< of the last step
  double seconds() const { return seconds_; }  ///< in the stages

  /// Steps in which the stress along x fell far more than elastic unloading by the step's strain
  /// would have let it: the law snaps back, and a path by strain jumps to what is left.
  int jumps() const { return jumps_; }
  struct Jump {
    double from, to, strain;  ///< stress along x [Pa] before and after, strain of the step
  };
  const Jump& first_jump() const { return first_jump_; }

 private:
  double residual(const PathStep& step, double x);
  Eigen::Matrix3d solve(const PathStep& step);
  bool good(double residual, const PathStep& step) const;
  void note_jump(const PathStep& step, double before);
  double stiffness() const;

  MaterialPoint& point_;
  MaterialPoint::State saved_;
  double guess_ = 0;
  int trials_ = 0, jumps_ = 0;
  Jump first_jump_{};
  long updates_ = 0;
  double seconds_ = 0;
};

}  // namespace krater
