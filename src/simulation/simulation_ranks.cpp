// SPDX-License-Identifier: GPL-3.0-or-later
// One scene on several ranks (distribute/distribution.hpp). All make the same scene and begin
// together; then the first leads, and the others do as it says.
#include <functional>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

#include "krater/core/errors.hpp"
#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"
#include "krater/simulation/simulation.hpp"
#include "simulation/orders.hpp"
#include "simulation/slabs.hpp"

namespace krater {

namespace {

/// All ranks are at it: an error that the others cannot know of would let them wait for ever.
template <class Work>
void together(const Work& work) {
  try {
    work();
  } catch (const NumericalError&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    ranks::give_up(fmt::format("krater: {}", e.what()), 2);
  }
}

/// What of a scene is not computed on several ranks yet; empty: all of it is.
std::string undistributed(const Scene& scene, const std::vector<std::unique_ptr<Body>>& bodies) {
  for (const auto& body : bodies)
    if (!body->options().material_points())
      return "body '" + body->name() + "': elements and particles";
  if (scene.method.reference != Reference::current && scene.contact.active)
    return "method.reference: contact on a fixed reference";
  if (scene.contact.active && scene.contact.normal == ContactNormal::logistic_regression)
    return "contact.normal: logistic_regression";
  return "";
}

/// How far around its blocks a rank needs the tiles of others (distribute/distribution.hpp).
int reach(const Scene& scene) {
  int closed = 0, pushing = 0;
  for (int a = 0; a < dimension(scene.frame); ++a) {
    const auto& sides = scene.grid.boundary[static_cast<std::size_t>(a)];
    closed += sides[0].closed() || sides[1].closed() ? 1 : 0;
    pushing += sides[0].pushes() || sides[1].pushes() ? 1 : 0;
  }
  const int levels = scene.grid.refine.empty() ? 0 : 1;
  return 1 + levels + (closed > 0 ? 1 : 0) + (pushing > 1 ? 1 : 0) + (scene.contact.active ? 1 : 0);
}

}  // namespace

void Simulation::plan_ranks() {
  if (ranks::alone()) return;
  if (const std::string what = undistributed(scene_, bodies_); !what.empty())
    throw InputError(what +
                     " cannot be computed on several ranks yet; start krater without mpirun: it "
                     "uses the cores of one machine");
  ranks_ =
      std::make_unique<Distribution>(geometry_.dimension, reach(scene_), columns_of(kernel_data_));
}

void Simulation::distribute() {
  if (!ranks_) return;
  together([this] { start(); });
  together_ = true;
}

void Simulation::follow(const std::function<Checkpoint()>& checkpoint) {
  for (;;) {
    const Told told = tell(Order::leave);
    if (told.order == Order::leave) return;
    try {
      together([&] {
        switch (told.order) {
          case Order::step:
            expect_survey(told.b);
            return advance(told.a);
          case Order::survey:
            return survey_together();
          case Order::assemble:
            return assemble_together();
          case Order::restore:
            return restore_together(checkpoint);
          case Order::column:
            return column_together(static_cast<int>(told.a), static_cast<int>(told.b), nullptr);
          case Order::open_slabs:
            return open_slabs_together(static_cast<int>(told.a));
          case Order::slab:
            return slab_together(static_cast<std::size_t>(told.a),
                                 static_cast<std::size_t>(told.b));
          case Order::leave:
            break;
        }
      });
    } catch (const NumericalError&) {  // the first rank has it too, and says it
    } catch (const InputError&) {
    }
  }
}

Simulation::~Simulation() {
  if (together_ && ranks::first()) tell(Order::leave);
}

void Simulation::restore(const Checkpoint& checkpoint) {
  if (!ranks_) {
    restore_here(checkpoint);
    return;
  }
  tell(Order::restore);
  together([&] { restore_together([&] { return checkpoint; }); });
}

/// All of them, or none.
void Simulation::restore_together(const std::function<Checkpoint()>& checkpoint) {
  std::string reason;
  try {
    release();
    surveyed_ = -1;
    restore_here(checkpoint());
  } catch (const InputError& e) {
    reason = e.what();
  } catch (const std::out_of_range&) {
    reason = "damaged, or written by another version of krater";
  }
  for (const auto& text : ranks::all_gather(std::as_bytes(std::span{reason})))
    if (!text.empty())
      throw InputError(std::string{reinterpret_cast<const char*>(text.data()), text.size()});
}

/// Asked for by the first while the others follow, or by all at the start. Once a step.
void Simulation::survey_together() const {
  if (surveyed_ == steps()) return;
  if (together_ && ranks::first()) tell(Order::survey);
  survey_.assign(static_cast<std::size_t>(set_count()), {});
  for_each(survey_.size(), [&](std::size_t s) { survey_[s] = survey_of_set(static_cast<int>(s)); });
  ranks_->share(grid_, survey_);
  surveyed_ = steps();
}

void Simulation::step(double until) {
  if (!ranks_) {
    advance(until);
    return;
  }
  tell(Order::step, until, survey_due_);
  together([&] { advance(until); });
}

void Simulation::assemble() {
  if (!ranks_ || assembled_) return;
  tell(Order::assemble);
  together([this] { assemble_together(); });
}

void Simulation::assemble_together() {
  if (!ranks_ || assembled_) return;
  ranks_->assemble(grid_);
  assembled_ = true;
}

void Simulation::release() {
  if (!ranks_ || !assembled_) return;
  ranks_->release(grid_);
  assembled_ = false;
}

}  // namespace krater
