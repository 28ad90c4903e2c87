// SPDX-License-Identifier: GPL-3.0-or-later
// Box, cylinder and sphere: contents of cells, measures and centroids exact to round-off in every
// frame (section.hpp).
//
// In the axisymmetric frame a solid must be one of revolution about the z axis: a cylinder along z
// or a sphere, centred on it. A box is refused. In plane strain a shape is its section y = 0 (box
// and cylinders across y: a rectangle; sphere and cylinder along y: a disc). All constructors throw
// std::invalid_argument with the reason.
#pragma once

#include "krater/geometry/solids/solid.hpp"

namespace krater {

/// The cut of a primitive by y = 0, in the plane (x, z).
struct Section {
  enum class Kind { empty, rectangle, disc } kind = Kind::empty;
  Rectangle rectangle{};  ///< bounds; of a disc too
  double x = 0, z = 0;    ///< centre of a disc
  double radius = 0;      ///< of a disc
};

/// What the primitives share: in 2D frames all work is done by their section.
class Primitive : public Solid {
 public:
  using Solid::contains;
  Box extent(Frame frame) const override;
  void clip_column(Frame frame, std::span<const Box> cells, CellPart* parts) const override;
  Place classify(Frame frame, const Box& cell) const override;
  CellPart clip(Frame frame, const Box& cell) const override;
  CellPart part(Frame frame, const Box& domain) const override { return clip(frame, domain); }

 protected:
  virtual Section section() const = 0;
  virtual Place classify_3d(const Box& cell) const = 0;
  virtual CellPart clip_3d(const Box& cell) const = 0;
};

class BoxSolid final : public Primitive {
 public:
  explicit BoxSolid(const Box& box);
  static BoxSolid centred(const std::array<double, 3>& centre, const std::array<double, 3>& size);
  /// From corners in grid axes; in the 2D frames y = -1/2 .. 1/2 m.
  static BoxSolid from_grid(Frame frame, const std::array<double, 3>& min,
                            const std::array<double, 3>& max);

  using Primitive::contains;
  bool contains(double x, double y, double z) const override;
  void spans(const Line& line, Spans& out) const override;
  std::optional<VolumeMoments> moments() const override;
  Box bounding_box() const override { return box_; }
  void require(Frame frame) const override;

 protected:
  Section section() const override;
  Place classify_3d(const Box& cell) const override;
  CellPart clip_3d(const Box& cell) const override;

 private:
  Box box_;
};

class CylinderSolid final : public Primitive {
 public:
  /// `base`: the centre of the end face from which `height` extends along +x, +y or +z (axis 0, 1,
  /// 2).
  CylinderSolid(double radius, double height, const std::array<double, 3>& base, int axis = 2);
  static CylinderSolid centred(double radius, double height, const std::array<double, 3>& centre,
                               int axis = 2);

  using Primitive::contains;
  bool contains(double x, double y, double z) const override;
  void spans(const Line& line, Spans& out) const override;
  bool revolved_about(const Line& axis) const override;
  std::optional<VolumeMoments> moments() const override;
  double support(const Vector3& d) const override;
  Box bounding_box() const override;
  void require(Frame frame) const override;
  std::optional<RoundForm> round_form() const override {
    RoundForm out{RoundForm::Kind::tube, 0, radius_, height_, base_, {}};
    out.axis[axis_] = 1;
    return out;
  }

 protected:
  Section section() const override;
  Place classify_3d(const Box& cell) const override;
  CellPart clip_3d(const Box& cell) const override;

 private:
  double radius_;
  double height_;
  std::array<double, 3> base_;
  std::size_t axis_;   ///< of the cylinder
  std::size_t first_;  ///< the axes across it
  std::size_t second_;
};

class SphereSolid final : public Primitive {
 public:
  SphereSolid(double radius, const std::array<double, 3>& centre);

  std::optional<RoundForm> round_form() const override {
    return RoundForm{RoundForm::Kind::sphere, 0, radius_, 0, centre_, {0, 0, 1}};
  }

  using Primitive::contains;
  bool contains(double x, double y, double z) const override;
  void spans(const Line& line, Spans& out) const override;
  bool revolved_about(const Line& axis) const override;
  std::optional<VolumeMoments> moments() const override;
  double support(const Vector3& d) const override;
  Box bounding_box() const override;
  void require(Frame frame) const override;

 protected:
  Section section() const override;
  Place classify_3d(const Box& cell) const override;
  CellPart clip_3d(const Box& cell) const override;

 private:
  double radius_;
  std::array<double, 3> centre_;
};

}  // namespace krater
