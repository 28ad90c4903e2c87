// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/contact/impulses.hpp"

#include <algorithm>
#include <utility>

namespace krater {

namespace {

Partner as_partner(FieldId field) { return {Partner::Kind::body, body_of(field)}; }

}  // namespace

void add_impulse(std::vector<ImpulsePair>& list, FieldId on, Partner by, const Triple& impulse) {
  auto at = std::find_if(list.begin(), list.end(),
                         [&](const ImpulsePair& p) { return p.on == on && p.by == by; });
  if (at == list.end()) at = list.insert(at, {on, by, {}});
  for (std::size_t a = 0; a < 3; ++a) at->impulse[a] += impulse[a];
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

void Impulses::add(const std::vector<ImpulsePair>& given, double share) {
  for (const ImpulsePair& g : given) {
    const auto [i, sign] = find(g.on, g.by);
    if (sign == 0) continue;
    for (std::size_t a = 0; a < 3; ++a) pairs_[i].impulse[a] += sign * share * g.impulse[a];
  }
}

Triple Impulses::of(FieldId on, Partner by) const {
  const auto [i, sign] = find(on, by);
  Triple out{};
  for (std::size_t a = 0; a < 3 && sign != 0; ++a) out[a] = sign * pairs_[i].impulse[a];
  return out;
}

}  // namespace krater
