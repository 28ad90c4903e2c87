// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file core/ranks.hpp
/// The processes that compute one scene together, each a part of the blocks. The only place that
/// calls MPI, as core/parallel.hpp is the only one that calls OpenMP; without it (the default
/// build, or a start without a launcher) there is one rank and nothing here costs anything.
/// All functions but index(), count() and on_this_machine() are collective: every rank calls them,
/// in the same order.
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "krater/core/reproducible_sum.hpp"

namespace krater::ranks {

/// Doubles from or for one rank.
struct Message {
  int rank;
  std::vector<double> data;
};

/// At the start of the program, if a launcher started it. Ranks but the first say nothing. A
/// program without MPI that a launcher started several times ends here: each would compute the
/// whole scene.
void start(int& argc, char**& argv);
/// At its end, on every rank that comes to it.
void finish();
/// This rank goes on alone: what follows is no work of several.
void part();
/// It is heard from now on: it knows something that the first rank does not.
void speak();
/// Ends all ranks at once: this one cannot go on, and the others would wait for it for ever.
[[noreturn]] void give_up(const std::string& why, int code);
/// "Open MPI v4.1.4", or "no MPI": for `krater --version`.
std::string description();

int index();  ///< 0 is the one that reads, writes and speaks
int count();
int on_this_machine();  ///< ranks that share its memory
inline bool alone() { return count() == 1; }
inline bool first() { return index() == 0; }

/// Sums over the ranks, in bits those of one rank that adds all terms.
void sum(std::span<ReproducibleSum> sums);
double max(double x);
/// Both at once: sums, and greatest of numbers.
void reduce(std::span<ReproducibleSum> sums, std::span<double> greatest);
/// What each rank has, by rank.
std::vector<std::vector<std::byte>> all_gather(std::span<const std::byte> own);
/// The same, one behind the other, where all know how many bytes that is of each rank.
std::vector<std::byte> all_gather(std::span<const std::byte> own, const std::vector<int>& sizes);
/// Of the first rank, to all.
void broadcast(std::span<double> data);
/// Send messages, and receive one from each rank of `from`, in its order. Every rank knows whom it
/// will hear from.
std::vector<Message> exchange(const std::vector<Message>& out, const std::vector<int>& from);
/// The same in two parts, with work in between; the messages must stay as they are until then. `in`
/// names the ranks, and keeps its memory.
void send(const std::vector<Message>& out);
void receive(std::vector<Message>& in);

/// Bytes and messages that this rank has sent, and seconds in these functions, since the start.
struct Traffic {
  double bytes = 0, messages = 0, seconds = 0;
};
const Traffic& traffic();

}  // namespace krater::ranks
