// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "krater/core/ranks.hpp"

namespace krater::ranks {

namespace {

struct World {
  int index = 0, count = 1, here = 1;
  bool started = false;
  int speech = -1;  ///< standard error of a rank that is silent otherwise
  MPI_Op both_op = MPI_OP_NULL;
  std::size_t sums = 0, greatest = 0;  ///< that reduce() lays out
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

/// Of what reduce() lays out: sums, then numbers.
void join(void* in, void* inout, int* count, MPI_Datatype*) {
  const auto* from = static_cast<const std::byte*>(in);
  auto* to = static_cast<std::byte*>(inout);
  for (int i = 0; i < *count; ++i) {
    for (std::size_t k = 0; k < world.sums; ++k, from += sizeof(ReproducibleSum)) {
      ReproducibleSum a, b;
      std::memcpy(&a, from, sizeof(a));
      std::memcpy(&b, to, sizeof(b));
      b += a;
      std::memcpy(to, &b, sizeof(b));
      to += sizeof(b);
    }
    for (std::size_t k = 0; k < world.greatest; ++k, from += sizeof(double), to += sizeof(double)) {
      double a, b;
      std::memcpy(&a, from, sizeof(a));
      std::memcpy(&b, to, sizeof(b));
      b = std::max(a, b);
      std::memcpy(to, &b, sizeof(b));
    }
  }
}

/// A launcher tells its children who they are.
constexpr std::array<const char*, 3> kLaunched{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};

bool launched() {
  return std::any_of(kLaunched.begin(), kLaunched.end(),
                     [](const char* name) { return std::getenv(name) != nullptr; });
}

/// MPI counts in int. The others wait for what cannot be sent: none goes on.
int as_count(std::size_t n) {
  if (n > 0x7FFFFFFF)
    give_up("krater: a message between two ranks is longer than 2^31 numbers: use more ranks", 3);
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
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &world.here);
  MPI_Comm_free(&machine);
  MPI_Op_create(join, 1, &world.both_op);
  if (world.index == 0) return;
  world.speech = dup(STDERR_FILENO);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  close(nowhere);
}

void finish() {
  if (!world.started) return;
  MPI_Op_free(&world.both_op);
  MPI_Finalize();
  world.started = false;
}

void part() {
  finish();
  world.index = 0;
  world.count = 1;
  world.here = 1;
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
int on_this_machine() { return world.here; }
const Traffic& traffic() { return world.traffic; }

void sum(std::span<ReproducibleSum> sums) { reduce(sums, {}); }

double max(double x) {
  reduce({}, {&x, 1});
  return x;
}

void reduce(std::span<ReproducibleSum> sums, std::span<double> greatest) {
  if (alone()) return;
  const Clock clock;
  const std::size_t bytes = sums.size_bytes() + greatest.size_bytes();
  sent(bytes);
  std::vector<std::byte> all(bytes);
  std::memcpy(all.data(), sums.data(), sums.size_bytes());
  std::memcpy(all.data() + sums.size_bytes(), greatest.data(), greatest.size_bytes());
  MPI_Datatype both = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(as_count(bytes), MPI_BYTE, &both);
  MPI_Type_commit(&both);
  world.sums = sums.size();
  world.greatest = greatest.size();
  MPI_Allreduce(MPI_IN_PLACE, all.data(), 1, both, world.both_op, MPI_COMM_WORLD);
  MPI_Type_free(&both);
  std::memcpy(sums.data(), all.data(), sums.size_bytes());
  std::memcpy(greatest.data(), all.data() + sums.size_bytes(), greatest.size_bytes());
}

std::vector<std::byte> all_gather(std::span<const std::byte> own, const std::vector<int>& sizes) {
  if (alone()) return {own.begin(), own.end()};
  const Clock clock;
  sent(own.size());
  std::vector<int> starts;
  std::size_t all = 0;
  for (const int size : sizes) {
    starts.push_back(as_count(all));
    all += static_cast<std::size_t>(size);
  }
  std::vector<std::byte> bytes(all);
  MPI_Allgatherv(own.data(), as_count(own.size()), MPI_BYTE, bytes.data(), sizes.data(),
                 starts.data(), MPI_BYTE, MPI_COMM_WORLD);
  return bytes;
}

std::vector<std::vector<std::byte>> all_gather(std::span<const std::byte> own) {
  if (alone()) return {{own.begin(), own.end()}};
  std::vector<int> sizes(static_cast<std::size_t>(world.count));
  const int size = as_count(own.size());
  {
    const Clock clock;
    sent(sizeof(size));
    MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, MPI_COMM_WORLD);
  }
  const std::vector<std::byte> bytes = all_gather(own, sizes);
  std::vector<std::vector<std::byte>> out;
  auto at = bytes.begin();
  for (const int n : sizes) {
    out.emplace_back(at, at + n);
    at += n;
  }
  return out;
}

void broadcast(std::span<double> data) {
  if (alone()) return;
  const Clock clock;
  if (first()) sent(data.size_bytes());
  MPI_Bcast(data.data(), as_count(data.size()), MPI_DOUBLE, 0, MPI_COMM_WORLD);
}

namespace {

constexpr int kTag = 1;  // messages between two ranks do not overtake each other
std::vector<MPI_Request> under_way;

}  // namespace

void send(const std::vector<Message>& out) {
  if (alone()) return;
  const Clock clock;
  for (const Message& message : out) {
    sent(message.data.size() * sizeof(double));
    MPI_Isend(message.data.data(), as_count(message.data.size()), MPI_DOUBLE, message.rank, kTag,
              MPI_COMM_WORLD, &under_way.emplace_back());
  }
}

void receive(std::vector<Message>& in) {
  if (alone()) return;
  const Clock clock;
  for (Message& message : in) {
    MPI_Status status;
    MPI_Probe(message.rank, kTag, MPI_COMM_WORLD, &status);
    int size = 0;
    MPI_Get_count(&status, MPI_DOUBLE, &size);
    message.data.resize(static_cast<std::size_t>(size));
    MPI_Recv(message.data.data(), size, MPI_DOUBLE, message.rank, kTag, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
  }
  MPI_Waitall(as_count(under_way.size()), under_way.data(), MPI_STATUSES_IGNORE);
  under_way.clear();
}

std::vector<Message> exchange(const std::vector<Message>& out, const std::vector<int>& from) {
  std::vector<Message> in;
  if (alone()) return in;
  for (const int rank : from) in.push_back({rank, {}});
  send(out);
  receive(in);
  return in;
}

}  // namespace krater::ranks
