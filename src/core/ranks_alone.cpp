// SPDX-License-Identifier: GPL-3.0-or-later
// Without MPI: one rank.
#include <cstdio>
#include <cstdlib>

#include "krater/core/ranks.hpp"

namespace krater::ranks {

void start(int&, char**&) {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* count = std::getenv(name);
    if (count == nullptr || std::atoi(count) < 2) continue;
    std::fprintf(
        stderr,
        "krater: started as one of %s processes, but built without MPI: tools/setup --mpi, "
        "then tools/build -DKRATER_MPI=ON\n",
        count);
    std::exit(2);
  }
}
void finish() {}
void part() {}
void speak() {}
void give_up(const std::string&, int code) { std::_Exit(code); }
std::string description() { return "no MPI"; }
int index() { return 0; }
int count() { return 1; }
int on_this_machine() { return 1; }
void sum(std::span<ReproducibleSum>) {}
double max(double x) { return x; }
void reduce(std::span<ReproducibleSum>, std::span<double>) {}
std::vector<std::vector<std::byte>> all_gather(std::span<const std::byte> own) {
  return {{own.begin(), own.end()}};
}
std::vector<std::byte> all_gather(std::span<const std::byte> own, const std::vector<int>&) {
  return {own.begin(), own.end()};
}
void broadcast(std::span<double>) {}
std::vector<Message> exchange(const std::vector<Message>&, const std::vector<int>&) { return {}; }
void send(const std::vector<Message>&) {}
void receive(std::vector<Message>&) {}
const Traffic& traffic() {
  static const Traffic none;
  return none;
}

}  // namespace krater::ranks
