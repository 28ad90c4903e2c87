// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "krater/core/errors.hpp"
#include "krater/core/ranks.hpp"

namespace krater::ranks {

namespace {

struct World {
  int index = 0, count = 1;
  bool started = false;
  int speech = -1;  ///< standard error of a rank that is silent otherwise
  MPI_Datatype sum_type = MPI_DATATYPE_NULL;
  MPI_Op sum_op = MPI_OP_NULL;
  Traffic traffic;
};
World world;

/// Notes the seconds that it lives.
class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  ~Clock() {
    world.traffic.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void sent(std::size_t bytes) {
  world.traffic.bytes += static_cast<double>(bytes);
  world.traffic.messages += 1;
}

void add_sums(void* in, void* inout, int* count, MPI_Datatype*) {
  const auto* terms = static_cast<const ReproducibleSum*>(in);
  auto* sums = static_cast<ReproducibleSum*>(inout);
  for (int i = 0; i < *count; ++i) sums[i] += terms[i];
}

/// A launcher tells its children who they are.
constexpr std::array<const char*, 3> kLaunched{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};

bool launched() {
  return std::any_of(kLaunched.begin(), kLaunched.end(),
                     [](const char* name) { return std::getenv(name) != nullptr; });
}

/// MPI counts in int.
int as_count(std::size_t n) {
  if (n > 0x7FFFFFFF)
    throw NumericalError("a message between two ranks is longer than 2^31 numbers: use more ranks");
  return static_cast<int>(n);
}

}  // namespace

void start(int& argc, char**& argv) {
  if (!launched()) return;
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  world.started = true;
  MPI_Comm_rank(MPI_COMM_WORLD, &world.index);
  MPI_Comm_size(MPI_COMM_WORLD, &world.count);
  MPI_Type_contiguous(sizeof(ReproducibleSum), MPI_BYTE, &world.sum_type);
  MPI_Type_commit(&world.sum_type);
  MPI_Op_create(add_sums, 1, &world.sum_op);
  if (world.index == 0) return;
  world.speech = dup(STDERR_FILENO);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  close(nowhere);
}

void finish() {
  if (!world.started) return;
  MPI_Op_free(&world.sum_op);
  MPI_Type_free(&world.sum_type);
  MPI_Finalize();
  world.started = false;
}

void part() {
  finish();
  world.index = 0;
  world.count = 1;
  for (const char* name : kLaunched) unsetenv(name);  // programs that this one starts are no ranks
}

void speak() {
  if (world.speech >= 0) dup2(world.speech, STDERR_FILENO);
}

void give_up(const std::string& why, int code) {
  speak();
  std::fprintf(stderr,
               "%s\nkrater: rank %d of %d cannot go on, so all end; the last checkpoint is whole\n",
               why.c_str(), world.index, world.count);
  std::fflush(stderr);
  MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

std::string description() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string whole{text, static_cast<std::size_t>(length)};
  return whole.substr(0, whole.find(','));
}

int index() { return world.index; }
int count() { return world.count; }
const Traffic& traffic() { return world.traffic; }

void sum(std::span<ReproducibleSum> sums) {
  if (alone()) return;
  const Clock clock;
  sent(sums.size_bytes());
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), as_count(sums.size()), world.sum_type, world.sum_op,
                MPI_COMM_WORLD);
}

double max(double x) {
  if (alone()) return x;
  const Clock clock;
  sent(sizeof(x));
  MPI_Allreduce(MPI_IN_PLACE, &x, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return x;
}

std::vector<std::vector<std::byte>> all_gather(std::span<const std::byte> own) {
  if (alone()) return {{own.begin(), own.end()}};
  const Clock clock;
  sent(own.size() + sizeof(int));
  const auto ranks = static_cast<std::size_t>(world.count);
  std::vector<int> sizes(ranks), starts(ranks);
  const int size = as_count(own.size());
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
  std::size_t all = 0;
  for (std::size_t r = 0; r < ranks; ++r) {
    starts[r] = as_count(all);
    all += static_cast<std::size_t>(sizes[r]);
  }
  std::vector<std::byte> bytes(all);
  MPI_Allgatherv(own.data(), size, MPI_BYTE, bytes.data(), sizes.data(), starts.data(), MPI_BYTE,
                 MPI_COMM_WORLD);
  std::vector<std::vector<std::byte>> out(ranks);
  for (std::size_t r = 0; r < ranks; ++r)
    out[r].assign(bytes.begin() + starts[r], bytes.begin() + starts[r] + sizes[r]);
  return out;
}

void broadcast(std::span<double> data) {
  if (alone()) return;
  const Clock clock;
  if (first()) sent(data.size_bytes());
  MPI_Bcast(data.data(), as_count(data.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

std::vector<Message> exchange(const std::vector<Message>& out, const std::vector<int>& from) {
  if (alone()) return {};
  const Clock clock;
  constexpr int kTag = 1;  // messages between two ranks do not overtake each other
  std::vector<MPI_Request> requests(out.size());
  for (std::size_t m = 0; m < out.size(); ++m) {
    sent(out[m].data.size() * sizeof(double));
    MPI_Isend(out[m].data.data(), as_count(out[m].data.size()), MPI_DOUBLE, out[m].rank, kTag,
              MPI_COMM_WORLD, &requests[m]);
  }
  std::vector<Message> in;
  for (const int rank : from) {
    MPI_Status status;
    MPI_Probe(rank, kTag, MPI_COMM_WORLD, &status);
    int size = 0;
    MPI_Get_count(&status, MPI_DOUBLE, &size);
    Message& message = in.emplace_back();
    message.rank = rank;
    message.data.resize(static_cast<std::size_t>(size));
    MPI_Recv(message.data.data(), size, MPI_DOUBLE, rank, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  MPI_Waitall(as_count(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return in;
}

}  // namespace krater::ranks
