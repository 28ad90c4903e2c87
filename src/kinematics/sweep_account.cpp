// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/kinematics/sweep_account.hpp"

namespace krater {

void note_limit(const SweepResult& result, int body, const PointStore& points, int id,
                TimeStepLimit& limit) {
  if (result.max_rate > limit.rate)
    limit = {result.max_rate, result.limiter, body, points.at(id, result.limiting)};
}

SweepAccount::SweepAccount(Audit& audit, const Standing& others)
    : audit_{audit}, others_lead_{others.law_lead} {
  audit_.internal = others.internal;
  audit_.unfelt = others.unfelt;
}

void SweepAccount::add(const SweepResult& result, double internal, double more_work,
                       bool barotropic) {
  audit_.internal += internal;
  audit_.book_events(result.ledger);
  if (!barotropic) return;
  audit_.unfelt += internal;
  law_work_ += result.ledger.barotropic_work + more_work;
}

void SweepAccount::close() {
  audit_.book_laws(law_work_, 0.5, others_lead_);  // they are half a step ahead of e
  audit_.find_unfelt();
}

}  // namespace krater
