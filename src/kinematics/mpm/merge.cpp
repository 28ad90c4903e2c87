// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/mpm/merge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "krater/kinematics/mpm/migrate.hpp"
#include "krater/kinematics/mpm/stretch.hpp"
#include "krater/points/ledger_fields.hpp"
#include "krater/points/load_fields.hpp"

namespace krater {

namespace {

constexpr double kCrowded = 2.5;             ///< points in a block, of what its mass is worth
constexpr double kLight = 0.6;               ///< of the mass of a point
constexpr double kLeast = 0.6, kMost = 1.5;  ///< of a point, together
constexpr double kClose = 0.1, kSmall = 0.05;

template <Field... F>
bool is_any(std::string_view name) {
  return ((name == F::info.name) || ...);
}

/// What has a rule of its own below.
bool is_special(std::string_view name) {
  return is_any<field::Id, field::Position, field::Velocity, field::AffineVelocity, field::Mass,
                field::Density, field::InternalEnergy, field::Domain, field::HalfWidth>(name);
}

/// What the next step makes anew from the rest, or what is no property of the material.
bool is_history(std::string_view name) {
  return !is_any<field::DeviatoricStress, field::Pressure, field::ViscousPressure,
                 field::SoundSpeed, field::ShockIndicator, field::GridVelocity,
                 field::BodyAcceleration, field::ReferencePosition, field::CarriedEnergy>(name);
}

/// The points of one patch that may merge, and those that did.
class Merging {
 public:
  Merging(Patch& patch, const GridGeometry& g, const BodyKernelData& body, const PointSize& size,
          const MergePlan& plan)
      : points_{patch.points}, g_{g}, c_{body.columns}, size_{size}, plan_{plan} {}

  bool crowded() const {
    double worth = 0;
    for (int i = 0; i < points_.count(); ++i) worth += share(i);
    return points_.count() > kCrowded * worth;
  }
  void run() {
    find_most();
    std::vector<std::pair<int, int>> light;  // bin, point
    for (int i = 0; i < points_.count(); ++i)
      if (share(i) < kLight) light.emplace_back(bin(i), i);
    std::sort(light.begin(), light.end());
    std::vector<int> group;
    for (std::size_t k = 0; k < light.size(); ++k) {
      group.push_back(light[k].second);
      if (k + 1 < light.size() && light[k + 1].first == light[k].first) continue;
      merge_bin(group);
      group.clear();
    }
    std::sort(gone_.begin(), gone_.end());
    points_.remove(gone_);
  }
  double heat() const { return heat_; }
  std::size_t fewer() const { return gone_.size(); }

 private:
  double mass(int i) const { return points_.at(c_.mass, i); }
  double volume(int i) const { return mass(i) / points_.at(c_.density, i); }
  /// Of the mass of a point of these cells.
  double share(int i) const { return mass(i) / size_.mass(g_, points_.at(c_.position, i)); }
  int bin(int i) const {
    int out = 0;
    for (int a = 0; a < g_.dimension; ++a) {
      const int n = size_.per_direction[static_cast<std::size_t>(a)],
                bins = n * block_edge(g_.dimension);
      const double t = g_.knots(points_.at(c_.position + kLanes * a, i), a);
      out = out * bins + floor_mod(static_cast<int>(std::floor(n * t)), bins);
    }
    return out;
  }
  void find_most() {
    for (const MergePlan::Entry& e : plan_.entries) {
      double most = 0;
      for (int i = 0; e.history && i < points_.count(); ++i)
        most = std::max(most, std::abs(points_.at(e.place, i)));
      most_.push_back(most);
    }
  }
  static int floor_mod(int i, int n) { return i - floor_div(i, n) * n; }

  void merge_bin(std::span<int> group);
  void halve(std::span<int> group);
  bool close(std::span<const int> group) const;
  bool stays_short(std::span<const int> group) const;
  void merge(std::span<const int> group);
  template <class Weight>
  double mean(std::span<const int> group, int place, const Weight& weight) const {
    double sum = 0, weights = 0;
    for (const int i : group) {
      sum += weight(i) * points_.at(place, i);
      weights += weight(i);
    }
    return sum / weights;
  }
  Triple centre(std::span<const int> group) const;
  DomainTensor domain(std::span<const int> group, const Triple& x) const;
  std::array<double, 9> affine(std::span<const int> group, const Triple& x, const Triple& v) const;
  double stretch(int i) const;
  void set_stretch(int i, double J);
  void set_domain(int i, const DomainTensor& M);

  PointStore& points_;
  const GridGeometry& g_;
  const PointColumns& c_;
  const PointSize& size_;
  const MergePlan& plan_;
  std::vector<double> most_;  ///< of each entry that is a history, in the block
  std::vector<int> gone_;
  double heat_ = 0;
};

void Merging::merge_bin(std::span<int> group) {
  if (group.size() < 2) return;
  double together = 0;
  for (const int i : group) together += share(i);
  if (together < kLeast) return;
  if (together > kMost) return halve(group);
  if (close(group) && stays_short(group)) merge(group);
}

void Merging::halve(std::span<int> group) {
  int longest = 0;
  double length = -1;
  for (int a = 0; a < g_.dimension; ++a) {
    const int place = c_.position + kLanes * a;
    const auto [low, high] = std::minmax_element(group.begin(), group.end(), [&](int i, int j) {
      return points_.at(place, i) < points_.at(place, j);
    });
    if (const double span = points_.at(place, *high) - points_.at(place, *low); span > length) {
      length = span;
      longest = place;
    }
  }
  std::sort(group.begin(), group.end(), [&](int i, int j) {
    return std::pair{points_.at(longest, i), i} < std::pair{points_.at(longest, j), j};
  });
  merge_bin(group.first(group.size() / 2));
  merge_bin(group.subspan(group.size() / 2));
}

bool Merging::close(std::span<const int> group) const {
  for (std::size_t k = 0; k < plan_.entries.size(); ++k) {
    const MergePlan::Entry& e = plan_.entries[k];
    if (!e.history) continue;
    double low = points_.at(e.place, group[0]), high = low;
    for (const int i : group) {
      low = std::min(low, points_.at(e.place, i));
      high = std::max(high, points_.at(e.place, i));
    }
    const double most = std::max(std::abs(low), std::abs(high));
    if (!(high - low <= e.absolute + kClose * most + kSmall * most_[k])) return false;
  }
  return true;
}

/// Together they are no point that would be split again.
bool Merging::stays_short(std::span<const int> group) const {
  if (!size_.halves) return true;
  const Triple half = longest_half(domain(group, centre(group)));
  return half[0] * half[0] + half[1] * half[1] + half[2] * half[2] <=
         kLongestHalf * kLongestHalf * g_.h * g_.h;
}

Triple Merging::centre(std::span<const int> group) const {
  Triple x{};
  for (int a = 0; a < g_.dimension; ++a) {
    const bool radius = size_.hoop && a == 0;
    x[static_cast<std::size_t>(a)] = mean(group, c_.position + kLanes * a, [&](int i) {
      return radius ? mass(i) / points_.at(c_.position, i) : mass(i);
    });
  }
  return x;
}

/// Of all of them about x, by the theorem of parallel axes.
DomainTensor Merging::domain(std::span<const int> group, const Triple& x) const {
  DomainTensor out = DomainTensor::Zero();
  double total = 0;
  for (const int i : group) {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    for (int a = 0; a < g_.dimension; ++a)
      d[a] = points_.at(c_.position + kLanes * a, i) - x[static_cast<std::size_t>(a)];
    const double share = size_.hoop ? mass(i) / points_.at(c_.position, i) : mass(i);
    out += share * (domain_of(points_, c_, g_.dimension, i) + 3 * d * d.transpose());
    total += share;
  }
  return out / total;
}

/// L with what keeps the angular momentum.
std::array<double, 9> Merging::affine(std::span<const int> group, const Triple& x,
                                      const Triple& v) const {
  const int dim = g_.dimension;
  const auto at = [&](int offset, int a, int i) { return points_.at(offset + kLanes * a, i); };
  std::array<double, 9> L{};
  for (int k = 0; k < dim * dim; ++k)
    L[static_cast<std::size_t>(k)] =
        mean(group, c_.affine + kLanes * k, [&](int i) { return mass(i); });
  for (int a = 0; a < dim && !size_.hoop; ++a)
    for (int b = a + 1; b < dim; ++b) {
      const auto p = static_cast<std::size_t>(a), q = static_cast<std::size_t>(b);
      double turn = 0, total = 0;
      for (const int i : group) {
        turn += mass(i) * ((at(c_.position, a, i) - x[p]) * (at(c_.velocity, b, i) - v[q]) -
                           (at(c_.position, b, i) - x[q]) * (at(c_.velocity, a, i) - v[p]));
        total += mass(i);
      }
      const double skew = turn / (total * 2 * Support::moment * g_.h * g_.h);
      L[static_cast<std::size_t>(dim * b + a)] += skew;
      L[static_cast<std::size_t>(dim * a + b)] -= skew;
    }
  return L;
}

/// det F
double Merging::stretch(int i) const {
  const auto F = [&](int row, int k) {
    return points_.at(c_.deformation + kLanes * (3 * row + k), i);
  };
  return F(0, 0) * (F(1, 1) * F(2, 2) - F(1, 2) * F(2, 1)) -
         F(0, 1) * (F(1, 0) * F(2, 2) - F(1, 2) * F(2, 0)) +
         F(0, 2) * (F(1, 0) * F(2, 1) - F(1, 1) * F(2, 0));
}

/// det F = J by as much along all axes of the grid.
void Merging::set_stretch(int i, double J) {
  const double factor = std::pow(J / stretch(i), 1.0 / g_.dimension);
  for (int row = 0; row < 3; ++row)
    for (int k = 0; k < 3; ++k)
      if (g_.dimension == 3 || (row != 1 && k != 1))
        points_.at(c_.deformation + kLanes * (3 * row + k), i) *= factor;
}

void Merging::set_domain(int i, const DomainTensor& M) {
  for (int a = 0; a < g_.dimension; ++a) {
    if (c_.half_width >= 0) points_.at(c_.half_width + kLanes * a, i) = std::sqrt(M(a, a));
    for (int b = a; b < g_.dimension; ++b)
      points_.at(c_.domain + kLanes * domain_component(g_.dimension, a, b), i) = M(a, b);
  }
}

/// The point of the lowest number takes what all of them have.
void Merging::merge(std::span<const int> group) {
  const int dim = g_.dimension;
  const auto by_mass = [&](int i) { return mass(i); };
  const auto by_volume = [&](int i) { return volume(i); };
  double before = 0, m = 0, V = 0, J = 0;
  for (const int i : group) {
    before += point_kinetic(points_.point(i), c_, g_);
    m += mass(i);
    V += volume(i);
    if (c_.deformation >= 0) J += mass(i) * stretch(i);
  }
  const Triple x = centre(group);
  Triple v{};
  for (int a = 0; a < dim; ++a)
    v[static_cast<std::size_t>(a)] = mean(group, c_.velocity + kLanes * a, by_mass);
  std::array<double, 9> L{};
  if (c_.affine >= 0) L = affine(group, x, v);
  std::vector<double> others;
  others.reserve(plan_.entries.size());
  for (const MergePlan::Entry& e : plan_.entries)
    others.push_back(e.by_volume ? mean(group, e.place, by_volume) : mean(group, e.place, by_mass));
  const double e = c_.energy >= 0 ? mean(group, c_.energy, by_mass) : 0;
  DomainTensor M = DomainTensor::Zero();
  if (c_.domain >= 0) M = domain(group, x);

  const int kept = *std::min_element(group.begin(), group.end(), [&](int i, int j) {
    return points_.at(0, i) < points_.at(0, j);  // the id stands at the head
  });
  for (int a = 0; a < dim; ++a) {
    points_.at(c_.position + kLanes * a, kept) = x[static_cast<std::size_t>(a)];
    points_.at(c_.velocity + kLanes * a, kept) = v[static_cast<std::size_t>(a)];
  }
  for (int k = 0; c_.affine >= 0 && k < dim * dim; ++k)
    points_.at(c_.affine + kLanes * k, kept) = L[static_cast<std::size_t>(k)];
  if (c_.domain >= 0) set_domain(kept, M);
  points_.at(c_.mass, kept) = m;
  points_.at(c_.density, kept) = m / V;
  for (std::size_t k = 0; k < others.size(); ++k)
    points_.at(plan_.entries[k].place, kept) = others[k];
  if (c_.deformation >= 0) set_stretch(kept, J / m);
  if (c_.energy >= 0) {
    const double heat = before - point_kinetic(points_.point(kept), c_, g_);
    points_.at(c_.energy, kept) = e;
    points_.at(heat < 0 && c_.carried >= 0 ? c_.carried : c_.energy, kept) += heat / m;
    heat_ += heat;
  }
  for (const int i : group)
    if (i != kept) gone_.push_back(i);
}

}  // namespace

MergePlan plan_merging(const Layout& layout, const PointColumns& columns) {
  MergePlan out;
  out.possible = columns.energy >= 0;  // rigid bodies have none
  for (const Column& column : layout.columns()) {
    const std::string_view name = column.field->name;
    if (is_any<field::LoadShare, field::LoadUnit>(name)) out.possible = false;
    if (is_special(name)) continue;
    const bool history = is_history(name),
               fraction = history && std::string_view{column.field->unit} == "1";
    for (int k = 0; k < column.components; ++k)
      out.entries.push_back(
          {column.offset + kLanes * k, fraction ? kSmall : 0,
           is_any<field::DeviatoricStress, field::Pressure, field::ViscousPressure>(name),
           history});
  }
  return out;
}

Merged merge_points(Patch& patch, const GridGeometry& geometry, const BodyKernelData& body,
                    const PointSize& size, const MergePlan& plan) {
  Merged out;
  if (!plan.possible || patch.points.count() < 2) return out;
  Merging merging{patch, geometry, body, size, plan};
  if (!merging.crowded()) return out;
  merging.run();
  out.points = static_cast<double>(merging.fewer());
  if (merging.fewer() == 0) return out;
  out.heat = merging.heat();
  if (body.heat_floor == nullptr) out.unfelt = out.heat;
  patch.touch();
  patch.steady = false;
  patch.points.pad(body.columns.mass);
  return out;
}

}  // namespace krater
