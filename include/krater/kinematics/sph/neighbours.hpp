// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file kinematics/sph/neighbours.hpp
/// Who is near whom: lists of all particles within R = 2h + skin, by linked cells of that size
/// (Hockney and Eastwood 1981). A list stands until a pair that it lacks may have come within 2h.
/// That is asked of displacements since it was made, u, cell by cell: of cells side by side the
/// widest |u_i - u_j| may be the skin; of cells with one between them the approach along that axis;
/// of any two, along each axis, the skin and R more. So neither flight nor a strain that is spread
/// over the body makes a list old, as the largest move would.
///
/// Across a plane of symmetry lie mirror images, x -> s x + o along its axis, of what is within R
/// of it and of as much more as a particle has come across; between two planes images of images, as
/// far as they are within R of the domain.
///
/// Lists are a function of the places that they were made of and of the order of particles, so a
/// restart that knows these places has the same ones.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "krater/kinematics/sph/sph_kernels.hpp"

namespace krater {

class Neighbours {
 public:
  struct Plane {
    std::size_t axis;
    double at;         ///< [m]
    double inwards;    ///< +1 or -1
    double reach = 0;  ///< what is within this of it has an image [m]
    double depth(const double* x) const { return inwards * (x[axis] - at); }
  };
  Neighbours() = default;
  /// `support`: 2h [m]; `skin` [m].
  Neighbours(int dimension, double support, double skin, std::vector<Plane> planes);

  /// Lists of `count` particles whose records of motion are given. Throws NumericalError where one
  /// is not within a million cells of the origin.
  void make(const double* motion, int count);
  bool stale(const double* motion) const;  ///< of the same particles where they are now

  const NeighbourRows* rows() const { return rows_.data(); }
  /// Particles and, from the first multiple of 8 beyond them, images.
  std::size_t records() const { return first_image_ + images_.size(); }
  std::size_t image_count() const { return images_.size(); }
  void reflect_motion(double* motion) const;  ///< records of the images from the particles'
  void reflect_load(double* load) const;

  double mean_count() const;  ///< listed neighbours of a particle
  std::int64_t made() const { return made_; }
  /// Places that the lists were made of, 3 each; put back by make_from().
  const std::vector<double>& places() const { return places_; }
  void make_from(const double* places, int count);
  std::size_t memory() const;  ///< [bytes]

 private:
  using Key = std::uint64_t;
  using Ranges = std::array<std::array<std::uint32_t, 2>, 9>;  ///< of items in sorted order
  struct Image {
    std::int32_t of;
    std::array<double, 3> sign, offset;
  };
  struct Cell {
    Key key;
    std::uint32_t first, last;  ///< in sorted order
  };
  struct CellPair {
    std::uint32_t low, high;
    std::array<std::int8_t, 3> apart;  ///< cells from low to high
  };
  struct Reach {
    std::array<double, 3> low, high;  ///< of the displacements in a cell
  };
  void find_images(int count);
  double deepest(const Plane& plane, const double* x, std::size_t stride) const;
  void sort_items(int count);
  void find_pairs();
  Ranges near_ranges(const Cell& cell) const;
  std::size_t list_near(int particle, const Ranges& ranges, std::vector<std::int32_t>& out) const;
  void list_groups(std::size_t chunk, int count);
  std::array<double, 3> place_of(std::uint32_t item) const;
  std::vector<Reach> reaches(const double* motion) const;
  bool may_meet(const CellPair& pair, const std::vector<Reach>& reach) const;

  int dim_ = 3;
  double support_ = 0, skin_ = 0, radius_ = 0;
  std::vector<Plane> planes_;
  std::size_t first_image_ = 0, count_ = 0;
  std::int64_t made_ = 0;
  std::vector<double> places_;
  std::vector<Image> images_;
  std::vector<std::uint32_t> order_, cell_of_;  ///< items in sorted order; cell of a particle
  std::vector<double> sorted_;                  ///< places in that order, 3 each
  std::vector<Cell> cells_;
  std::vector<CellPair> pairs_;
  std::vector<std::vector<std::int32_t>> storage_;  ///< rows of a chunk of groups
  std::vector<NeighbourRows> rows_;
};

/// Order in which particles are kept: along a curve through cells of `size` [m], then as given.
std::vector<std::uint32_t> order_along_curve(const std::vector<std::array<double, 3>>& places,
                                             double size);

}  // namespace krater
