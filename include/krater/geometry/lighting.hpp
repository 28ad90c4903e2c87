// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file geometry/lighting.hpp
/// When a detonation that starts at points, lines or planes reaches a place in explosives
/// (Huygens):
///   t(x) = min over sources and paths in explosive of  t_source + int ds/D
/// so a front goes straight where it can see its source, bends about whatever is not explosive, and
/// passes from one explosive to another where they touch. Exact in sight of a source; behind an
/// obstacle a path bends at nodes of a lattice near its corners, half a spacing off at most, and
/// refraction between explosives of different D happens at nodes too.
///
/// Method: Dijkstra's over a lattice of nodes in the explosives, where a node takes its
/// neighbour's own predecessor if it sees it (theta*, Nash and others 2007; lazily, 2010), so that
/// paths are straight between corners and not along the lattice. What is thinner than two spacings
/// may be overlooked.
/// Positions are in grid axes; about the axis of symmetry the half plane r >= 0 holds the shortest
/// path.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "krater/geometry/frame.hpp"
#include "krater/geometry/solids/solid.hpp"

namespace krater {

struct Detonator {
  enum class Kind { point, line, plane };
  std::string name, where;
  Kind kind = Kind::point;
  std::array<double, 3> a{}, b{};  ///< point; ends of a line; point and unit normal of a plane
  double time = 0;                 ///< [s]
  std::array<double, 3> nearest(const std::array<double, 3>& x) const;
};

struct Explosive {
  const Solid* solid;
  double speed;  ///< D [m/s]
};

class Lighting {
 public:
  using Spot = std::array<double, 3>;

  /// `domain` in grid axes, `spacing` of the lattice [m].
  Lighting(Frame frame, const Box& domain, double spacing, std::vector<Explosive> explosives,
           std::vector<Detonator> detonators);

  /// Time at a place in an explosive [s]; infinite where no front comes.
  double at(int explosive, const Spot& x) const;
  /// Detonators with no explosive within a spacing.
  const std::vector<int>& idle() const { return idle_; }

 private:
  struct Node {
    double time;
    Spot from{};  ///< where the straight part of the path began ...
    double from_time = 0;
    int source = -1;  ///< ... or, if it is a detonator, anywhere on it
    bool seen = false, closed = false;
  };
  struct Start {
    Spot from;
    double time;
  };

  void mark_explosives(const Box& domain);
  void light_sources();
  void spread();
  /// False: the path was not as thought, and the node has another time now.
  bool confirm(int n);
  void offer(int from, int to);
  Start start_of(const Node& node, const Spot& x) const;
  bool sees(int explosive, const Spot& a, const Spot& b) const;
  bool near_explosive(int explosive, const Spot& x) const;
  Spot place(int n) const;
  std::array<int, 3> index(int n) const;
  int node_at(const std::array<int, 3>& i) const;  ///< -1: outside
  template <class Visit>
  void around(const std::array<int, 3>& centre, int reach, const Visit& visit) const;

  Frame frame_;
  int dimension_;
  double spacing_;
  Spot origin_{};  ///< of node 0
  std::array<int, 3> count_{1, 1, 1};
  std::vector<Explosive> explosives_;
  std::vector<Detonator> detonators_;
  std::vector<std::int8_t> owner_;  ///< explosive of each node, -1: none
  std::vector<Node> nodes_;
  std::vector<std::pair<double, int>> queue_;  ///< heap, earliest first
  std::vector<int> idle_;
};

}  // namespace krater
