// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/contact/impulses.hpp"

#include <algorithm>
#include <utility>

#include "krater/core/ranks.hpp"

namespace krater {

namespace {

Partner as_partner(FieldId field) { return {Partner::Kind::body, body_of(field)}; }

}  // namespace

namespace {

ImpulseSum& entry_of(std::vector<ImpulseSum>& list, FieldId on, Partner by) {
  auto at = std::find_if(list.begin(), list.end(),
                         [&](const ImpulseSum& p) { return p.on == on && p.by == by; });
  if (at == list.end()) at = list.insert(at, {on, by, {}});
  return *at;
}

}  // namespace

void add_impulse(std::vector<ImpulseSum>& list, FieldId on, Partner by, const Triple& impulse) {
  ImpulseSum& entry = entry_of(list, on, by);
  for (std::size_t a = 0; a < 3; ++a) entry.impulse[a] += impulse[a];
}

void add_impulses(std::vector<ImpulseSum>& list, const std::vector<ImpulseSum>& more) {
  for (const ImpulseSum& m : more) {
    ImpulseSum& entry = entry_of(list, m.on, m.by);
    for (std::size_t a = 0; a < 3; ++a) entry.impulse[a] += m.impulse[a];
  }
}

std::pair<std::size_t, double> Impulses::find(FieldId on, Partner by) const {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (pairs_[i].on == on && pairs_[i].by == by) return {i, 1};
    if (as_partner(pairs_[i].on) == by && pairs_[i].by == as_partner(on)) return {i, -1};
  }
  return {0, 0};
}

void Impulses::watch(FieldId on, Partner by) {
  if (find(on, by).second == 0) pairs_.push_back({on, by, {}});
}

void Impulses::add(const std::vector<ImpulseSum>& given, double share) {
  // Both ways round of every pair, for a sum has no factor.
  std::vector<ReproducibleSum> sums(6 * pairs_.size());
  for (const ImpulseSum& g : given) {
    const auto [i, sign] = find(g.on, g.by);
    if (sign == 0) continue;
    const std::size_t first = 6 * i + (sign > 0 ? 0 : 3);
    for (std::size_t a = 0; a < 3; ++a) sums[first + a] += g.impulse[a];
  }
  ranks::sum(sums);
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a)
      pairs_[i].impulse[a] += share * (sums[6 * i + a].value() - sums[6 * i + 3 + a].value());
}

void Impulses::book(FieldId on, Partner by, const Triple& impulse) {
  const auto [i, sign] = find(on, by);
  for (std::size_t a = 0; a < 3 && sign != 0; ++a) pairs_[i].impulse[a] += sign * impulse[a];
}

Triple Impulses::of(FieldId on, Partner by) const {
  const auto [i, sign] = find(on, by);
  Triple out{};
  for (std::size_t a = 0; a < 3 && sign != 0; ++a) out[a] = sign * pairs_[i].impulse[a];
  return out;
}

}  // namespace krater
