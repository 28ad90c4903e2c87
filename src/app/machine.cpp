// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/app/machine.hpp"

#include <ctime>
#include <fstream>
#include <string>

#include <unistd.h>

#include "krater/app/version.hpp"
#include "krater/core/parallel.hpp"
#include "krater/core/ranks.hpp"

namespace krater {

std::int64_t peak_resident_bytes() {
  std::ifstream status{"/proc/self/status"};
  for (std::string key; status >> key; status.ignore(1000, '\n')) {
    std::int64_t kilobytes = 0;
    if (key == "VmHWM:" && status >> kilobytes) return 1024 * kilobytes;
  }
  return 0;
}

Json machine_json(const Simulation& sim, double seconds, double point_steps) {
  Json out;
  char host[256] = {};
  gethostname(host, sizeof(host) - 1);
  out["host"] = Json::of(std::string{host});
  out["threads"] = Json::of(static_cast<std::int64_t>(threads()));
  out["ranks"] = Json::of(static_cast<std::int64_t>(ranks::count()));
  if (sim.distribution() != nullptr) {
    const ranks::Traffic& traffic = ranks::traffic();  // of the first rank
    out["rank_bytes_sent"] = Json::of(traffic.bytes);
    out["rank_messages"] = Json::of(traffic.messages);
    out["seconds_in_messages"] = Json::of(traffic.seconds);
    out["times_dealt_anew"] = Json::of(static_cast<std::int64_t>(sim.distribution()->times_cut()));
    out["imbalance"] = Json::of(sim.distribution()->imbalance(sim.grid()));
  }
  out["instruction_set"] = Json::of(std::string{name_of(sim.isa_level())});
  out["bytes_per_point"] = Json::of(sim.bytes_per_point());
  out["peak_resident_bytes"] = Json::of(peak_resident_bytes());
  out["wall_seconds"] = Json::of(seconds);
  out["processor_seconds"] = Json::of(static_cast<double>(std::clock()) / CLOCKS_PER_SEC);
  Json& phases = out["seconds"];
  for (std::size_t i = 0; i < phase_names.size(); ++i)
    phases[phase_names[i]] = Json::of(sim.stepper().seconds(static_cast<Phase>(i)));
  out["point_steps_per_second"] = Json::of(seconds > 0 ? point_steps / seconds : 0.0);
  return out;
}

Json program_json() {
  const Version v = version();
  Json program;
  program["version"] = Json::of(v.program);
  program["revision"] = Json::of(v.revision);
  program["compiler"] = Json::of(v.compiler);
  program["build"] = Json::of(v.build);
  return program;
}

}  // namespace krater
