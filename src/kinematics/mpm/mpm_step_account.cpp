// SPDX-License-Identifier: GPL-3.0-or-later
// The account of a step: what the nodes did, and what the patches found.
#include "krater/core/parallel.hpp"
#include "krater/kinematics/mpm/mpm_step.hpp"

namespace krater {

// Not where body forces act: their work on the points is known after the gather only.
void MpmStep::watch_energy() const {
  const Constraints& c = constraints_;
  if (loaded_) return;
  energy_watch_.check_nodes(audit_, grid_kinetic_ + c.change(),
                            {audit_.step_external + c.contact.driven, c.walls.work});
}

// k of all nodes, when v+ is final, in place of the volumes.
void MpmStep::write_node_work() {
  const bool moments = settings(0).moments;
  for_each(
      grid_.node_blocks().size(),
      [&](std::size_t n) {
        if (!keeps_volumes(grid_.node_blocks()[n])) kernels_.work(grid_.node_blocks()[n], moments);
      },
      few_blocks());
  lap(Phase::nodes);
  heat_ = {};
  if (contact_.active())
    heat_.contact = reference_contact_ ? reference_contact_->heat() : contact_.heat();
  heat_.walls = boundary_.heat();
  ties_.finish_work(moments);
  lap(Phase::boundary);
}

void MpmStep::book() {
  const Constraints& c = constraints_;
  audit_.book_step(heat_);
  audit_.external_work += c.contact.driven;
  audit_.wall_work += c.walls.work;
  audit_.friction_work += c.contact.friction;
  audit_.contact_pairs = others_.contact_pairs + c.contact.nodes;
  book_impulses();
  audit_.wall_columns = c.walls.columns_in_contact;
}

void MpmStep::combine_patches(GatherPart part) {
  const bool forces_worked = part != GatherPart::strain_move && part != GatherPart::strain_only;
  const bool strains = part != GatherPart::velocity_only && part != GatherPart::velocity_move &&
                       part != GatherPart::keep_only;
  audit_.kinetic = others_.kinetic;
  audit_.internal = others_.internal;
  audit_.unfelt = others_.unfelt;
  double law_work = 0;
  limit_ = {};
  for (std::size_t p = 0; p < grid_.patches().size(); ++p) {
    const PatchResult& r = grid_.patches()[p].result;
    if (feels_no_energy(p)) {
      audit_.unfelt += r.internal;
      law_work += r.ledger.barotropic_work;
    }
    audit_.kinetic += r.kinetic;
    audit_.internal += r.internal;
    if (forces_worked) {
      audit_.step_external += r.external_work;
      for (std::size_t a = 0; a < 3; ++a) constraints_.walls.impulse[a] += r.cut_impulse[a];
      heat_.given += r.heat_given;
      heat_.taken += r.heat_taken;
      heat_.carried += r.carried;
      heat_.carriers += r.carriers;
    }
    audit_.book_events(r.ledger);
    if (r.max_rate > limit_.rate)
      limit_ = {r.max_rate, r.limiter, grid_.patches()[p].body, 1.0 * r.limiting_point};
  }
  // e is that of the middle of a step; the laws are half a step ahead of it, under usf behind.
  if (strains)
    audit_.book_laws(law_work, method_.update == Update::usf ? -0.5 : 0.5, others_.law_lead);
  // The points of a fixed reference cross no cell, but bodies must see each other before they meet.
  if (reference_contact_ && reference_contact_->travel_rate() > limit_.rate)
    limit_ = {reference_contact_->travel_rate(), 1, limit_.body, limit_.id};
}

}  // namespace krater
