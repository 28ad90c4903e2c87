// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of a scene, timed one by one: `tools/bench` builds and runs it. No files are written
// and nothing is measured on the way, so that two runs of different length differ by steps alone
// (counts of instructions), and a median over steps is not that of the machine's other users.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "krater/app/machine.hpp"
#include "krater/core/parallel.hpp"
#include "krater/core/parallel_account.hpp"
#include "krater/core/waiting.hpp"
#include "krater/simulation/simulation.hpp"

namespace {

using namespace krater;

struct Options {
  std::string scene;
  std::vector<std::string> overrides;
  int steps = 40, warm = 10, threads = 1;
  bool flow = true;  ///< take more steps, untimed, to see how many points change cell and block
};

[[noreturn]] void usage() {
  std::fprintf(stderr,
               "usage: krater_bench_steps SCENE [--steps N] [--warm N] [--threads N] [--no-flow] "
               "[--set path=value]...\n");
  std::exit(2);
}

Options read_options(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--no-flow") {
      o.flow = false;
    } else if (word.starts_with("--") && i + 1 < argc) {
      const char* value = argv[++i];
      if (word == "--set")
        o.overrides.emplace_back(value);
      else if (word == "--steps")
        o.steps = std::atoi(value);
      else if (word == "--warm")
        o.warm = std::atoi(value);
      else if (word == "--threads")
        o.threads = std::atoi(value);
      else
        usage();
    } else if (o.scene.empty() && !word.starts_with("--")) {
      o.scene = word;
    } else {
      usage();
    }
  }
  if (o.scene.empty() || o.steps < 1 || o.warm < 0 || o.threads < 1) usage();
  return o;
}

struct Place {
  BlockKey block;
  std::array<int, 3> cell;
};

/// Block and cell of every point, by body and id.
std::map<std::pair<int, double>, Place> places(const Simulation& sim) {
  std::map<std::pair<int, double>, Place> out;
  const GridGeometry& grid = sim.geometry();
  for (std::size_t p = 0; p < sim.grid().patches().size(); ++p) {
    const Patch& patch = sim.grid().patches()[p];
    const Body& body = *sim.bodies()[static_cast<std::size_t>(patch.body)];
    for (int i = 0; i < patch.points.count(); ++i) {
      Place place{patch.key, {}};
      for (int a = 0; a < grid.dimension; ++a)
        place.cell[static_cast<std::size_t>(a)] = static_cast<int>(std::floor(
            grid.storage(sim.value(static_cast<int>(p), i, body.slot(field::Position::info, a)),
                         a) -
            0.5));
      out[{patch.body, sim.value(static_cast<int>(p), i, body.slot(field::Id::info))}] = place;
    }
  }
  return out;
}

struct Flow {
  double cells = 0, blocks = 0;  ///< shares of the points that changed theirs in one step
};

/// Mean over some steps: the points lie on a lattice, whose layers cross together.
Flow watch_flow(Simulation& sim, double until) {
  constexpr int steps = 8;
  Flow flow;
  auto before = places(sim);
  for (int n = 0; n < steps && !sim.done(); ++n) {
    sim.step(until);
    auto after = places(sim);
    double cells = 0, blocks = 0;
    for (const auto& [id, now] : after) {
      const auto was = before.find(id);
      if (was == before.end()) continue;
      cells += was->second.cell != now.cell;
      blocks += was->second.block != now.block;
    }
    flow.cells += cells / static_cast<double>(before.size()) / steps;
    flow.blocks += blocks / static_cast<double>(before.size()) / steps;
    before = std::move(after);
  }
  return flow;
}

/// Over all bits of all points, in the order of their ids.
std::uint64_t state_hash(const Simulation& sim) {
  std::uint64_t hash = 1469598103934665603U;
  for (std::size_t b = 0; b < sim.bodies().size(); ++b) {
    const int slots = sim.bodies()[b]->layout().stride() / kLanes;
    for (const auto& [patch, point] : sim.points_by_id(static_cast<int>(b)))
      for (int s = 0; s < slots; ++s) {
        const double value = sim.value(patch, point, s);
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof(bits));
        hash = (hash ^ bits) * 1099511628211U;
      }
  }
  return hash;
}

double quantile(std::vector<double> values, double share) {
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

/// Median, lower quartile and mean in ns per point.
void print_times(const char* name, const std::vector<double>& seconds, double points) {
  double total = 0;
  for (const double s : seconds) total += s;
  const double scale = 1e9 / points;
  std::printf("\"%s\": {\"median\": %.3f, \"quartile\": %.3f, \"mean\": %.3f}", name,
              scale * quantile(seconds, 0.5), scale * quantile(seconds, 0.25),
              scale * total / static_cast<double>(seconds.size()));
}

struct Samples {
  std::array<std::vector<double>, phase_names.size()> phases;  ///< [s] per step
  std::vector<double> step;                                    ///< [s] wall clock
  std::vector<double> cpu;                                     ///< [s] of all threads together
};

/// Of the process: other programs on the machine take wall-clock time, not this.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Samples time_steps(Simulation& sim, int steps, double until) {
  using Clock = std::chrono::steady_clock;
  Samples samples;
  for (int n = 0; n < steps && !sim.done(); ++n) {
    std::array<double, phase_names.size()> before{};
    for (std::size_t k = 0; k < before.size(); ++k)
      before[k] = sim.stepper().seconds(static_cast<Phase>(k));
    const double cpu = cpu_seconds();
    const auto start = Clock::now();
    sim.step(until);
    samples.step.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    samples.cpu.push_back(cpu_seconds() - cpu);
    for (std::size_t k = 0; k < before.size(); ++k)
      samples.phases[k].push_back(sim.stepper().seconds(static_cast<Phase>(k)) - before[k]);
  }
  return samples;
}

void print_state(const Simulation& sim) {
  std::size_t asleep = 0;
  for (const Patch& p : sim.grid().patches()) asleep += p.tile.state == Tile::State::asleep;
  double record = 0;
  for (const Patch& p : sim.grid().patches())
    record += 8.0 * p.points.count() *
              sim.bodies()[static_cast<std::size_t>(p.body)]->layout().stride() / kLanes /
              static_cast<double>(sim.point_count());
  std::printf("{\"points\": %zu, \"steps\": %lld, \"threads\": %d, \"instruction_set\": \"%s\",\n",
              sim.point_count(), static_cast<long long>(sim.steps()), threads(),
              name_of(sim.isa_level()));
  std::printf(
      " \"dt\": %.6g, \"time\": %.6g, \"patches\": %zu, \"asleep\": %zu, "
      "\"node_blocks\": %zu,\n",
      sim.dt(), sim.time(), sim.grid().patches().size(), asleep, sim.grid().node_blocks().size());
  std::printf(
      " \"record_bytes\": %.2f, \"bytes_per_point\": %.2f, \"resident_bytes_per_point\": %.2f, "
      "\"hash\": \"%016llx\",\n",
      record, sim.bytes_per_point(),
      static_cast<double>(peak_resident_bytes()) / static_cast<double>(sim.point_count()),
      static_cast<unsigned long long>(state_hash(sim)));
}

/// What of the steps several threads can share: calls of for_each by their number of items, per
/// step, and how long a call without work takes with the threads that there are [us].
void print_sharing(const ParallelAccount& account, double steps) {
  constexpr int tries = 200;
  const auto start = std::chrono::steady_clock::now();
  for (int n = 0; n < tries; ++n) for_each(1000, [](std::size_t) {});
  const double empty =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / tries;
  std::printf(",\n \"empty_us\": %.3f, \"shared\": [", 1e6 * empty);
  const char* comma = "";
  for (const auto& [items, region] : account.by_items) {
    std::printf("%s{\"items\": %zu, \"calls\": %.3f, \"us\": %.3f}", comma, items,
                static_cast<double>(region.calls) / steps, 1e6 * region.seconds / steps);
    comma = ", ";
  }
  std::printf("]}\n");
}

}  // namespace

/// krater_bench_steps SCENE ...: JSON on stdout.
int main(int argc, char** argv) try {
  wait_briefly(argv);
  const Options options = read_options(argc, argv);
  set_threads(options.threads);
  flush_denormals();
  const Scene scene = read_scene(options.scene, options.overrides);
  Simulation sim{scene};
  const double until = scene.time.end;
  for (int n = 0; n < options.warm && !sim.done(); ++n) sim.step(until);
  ParallelAccount account;
  keep_account(&account);
  const Samples samples = time_steps(sim, options.steps, until);
  keep_account(nullptr);
  if (samples.step.empty()) {
    std::fprintf(stderr, "krater_bench_steps: the scene ends before the first timed step\n");
    return 1;
  }
  print_state(sim);
  const auto points = static_cast<double>(sim.point_count());
  std::printf(" \"timed\": %zu, \"ns\": {", samples.step.size());
  for (std::size_t k = 0; k < phase_names.size(); ++k) {
    print_times(phase_names[k], samples.phases[k], points);
    std::printf(", ");
  }
  print_times("step", samples.step, points);
  std::printf(", ");
  print_times("cpu", samples.cpu, points);
  const Flow flow = options.flow && !sim.done() ? watch_flow(sim, until) : Flow{};
  std::printf("},\n \"change_cell\": %.4f, \"change_block\": %.4f", flow.cells, flow.blocks);
  print_sharing(account, static_cast<double>(samples.step.size()));
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "krater_bench_steps: %s\n", e.what());
  return 1;
}
