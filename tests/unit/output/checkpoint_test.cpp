// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cstring>
#include <limits>

#include "krater/core/errors.hpp"
#include "krater/output/results.hpp"
#include "output/hdf5_file.hpp"
#include "output_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

Checkpoint small_checkpoint() {
  return {{{"points/rod/pressure", {2, 2}, {1, 2, 3, 4}, {}, {}},
           {"a step", {}, {}, {std::numeric_limits<std::int64_t>::min(), -1}, {}},
           {"scene", {}, {}, {}, std::string("title: \0\xff\n", 10)},
           {"points/empty", {0, 3}, {}, {}, {}}}};
}

std::string save(const TemporaryFolder& folder, const Checkpoint& checkpoint) {
  ResultsFolder results(folder / "run");
  results.write_checkpoint(checkpoint);
  return folder / "run/checkpoint.h5";
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("checkpoint: blobs come back in order, with shape and kind") {
    const TemporaryFolder folder;
    const Checkpoint written = small_checkpoint(), read = read_checkpoint(save(folder, written));
    REQUIRE(read.blobs.size() == written.blobs.size());
    for (std::size_t i = 0; i < read.blobs.size(); ++i) {
      CAPTURE(written.blobs[i].name);
      CHECK(read.blobs[i].name == written.blobs[i].name);
      CHECK(read.blobs[i].doubles == written.blobs[i].doubles);
      CHECK(read.blobs[i].integers == written.blobs[i].integers);
      CHECK(read.blobs[i].text == written.blobs[i].text);
    }
    CHECK(read.blobs[0].shape == std::vector<std::uint64_t>{2, 2});
    CHECK(read.blobs[1].shape == std::vector<std::uint64_t>{2});
    CHECK(read.blobs[3].shape == std::vector<std::uint64_t>{0, 3});
    CHECK(read.find("scene") == &read.blobs[2]);
    CHECK(read.find("nothing") == nullptr);
  }

  TEST_CASE("checkpoint: every bit of a double comes back") {
    const TemporaryFolder folder;
    std::vector<std::uint64_t> bits{0x0,
                                    0x8000000000000000,   // -0.0
                                    0x1,                  // smallest denormal
                                    0x800fffffffffffff,   // largest negative denormal
                                    0x7ff0000000000000,   // infinity
                                    0xfff0000000000000,   // -infinity
                                    0x7ff8000000000000,   // quiet NaN
                                    0xfff8dead0000beef,   // quiet NaN with sign and payload
                                    0x7ff0000000000001};  // signalling NaN
    std::uint64_t x = 88172645463325252;
    for (int i = 0; i < 10000; ++i) {  // any bits at all
      x ^= x << 13, x ^= x >> 7, x ^= x << 17;
      bits.push_back(x);
    }
    Checkpoint checkpoint{{{"bits", {}, {}, {}, {}}}};
    checkpoint.blobs[0].doubles.resize(bits.size());
    std::memcpy(checkpoint.blobs[0].doubles.data(), bits.data(), 8 * bits.size());
    const Checkpoint read = read_checkpoint(save(folder, checkpoint));
    REQUIRE(read.blobs[0].doubles.size() == bits.size());
    CHECK(std::memcmp(read.blobs[0].doubles.data(), bits.data(), 8 * bits.size()) == 0);
  }

  TEST_CASE("checkpoint: the same state is the same bytes, and replaces the older one") {
    const TemporaryFolder folder;
    ResultsFolder results(folder / "run");
    results.write_checkpoint({{{"old", {}, {1}, {}, {}}}});
    results.write_checkpoint(small_checkpoint());
    const std::string first = read_file(folder / "run/checkpoint.h5");
    CHECK(read_checkpoint(folder / "run/checkpoint.h5").find("old") == nullptr);
    results.write_checkpoint(small_checkpoint());
    CHECK(read_file(folder / "run/checkpoint.h5") == first);
  }

  TEST_CASE("checkpoint: cut off at any length, it is refused") {
    const TemporaryFolder folder;
    const std::string bytes = read_file(save(folder, small_checkpoint()));
    const std::string cut = folder / "cut.h5";
    REQUIRE(bytes.size() > 2000);
    int refused = 0, lengths = 0;
    for (std::size_t length = 0; length < bytes.size(); length += length < 100 ? 1 : 37) {
      write_file(cut, bytes.substr(0, length));
      const std::string message = message_of<InputError>([&] { read_checkpoint(cut); });
      refused += message.find(cut + ": not an HDF5 file, or truncated") == 0;
      ++lengths;
    }
    CHECK(refused == lengths);
    write_file(cut, bytes.substr(0, bytes.size() - 1));
    CHECK_THROWS_AS(read_checkpoint(cut), InputError);
  }

  TEST_CASE("checkpoint: a flipped bit of the data is noticed") {
    const TemporaryFolder folder;
    const std::string path = save(folder, {{{"state", {}, {1.0, 1.25, 1.5}, {}, {}}}});
    std::string bytes = read_file(path);
    const double wanted = 1.25;
    const std::string pattern(reinterpret_cast<const char*>(&wanted), sizeof wanted);
    const std::size_t at = bytes.find(pattern);
    REQUIRE(at != std::string::npos);
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    write_file(path, bytes);
    CHECK(message_of<InputError>([&] { read_checkpoint(path); }) ==
          path + ": damaged: wrong checksum of 'state'");
  }

  TEST_CASE("checkpoint: what is missing, foreign or of another version is named") {
    const TemporaryFolder folder;
    const auto message = [&](const std::string& name) {
      return message_of<InputError>([&] { read_checkpoint(folder / name); });
    };
    CHECK(message("none.h5") ==
          (folder / "none.h5") + ": cannot be read: No such file or directory");
    CHECK(message("") == (folder / "") + ": cannot be read: not a plain file");
    write_file(folder / "text.h5", "title: not a checkpoint\n");
    CHECK(message("text.h5").find("not an HDF5 file") != std::string::npos);

    output::MemoryFile foreign(folder / "foreign.h5");
    foreign.set("magic", std::string("somebody else's"));
    foreign.set("format", std::int64_t{1});
    foreign.save();
    CHECK(message("foreign.h5") == (folder / "foreign.h5") + ": not a checkpoint of krater");

    output::MemoryFile later(folder / "later.h5");
    later.set("magic", std::string("krater checkpoint"));
    later.set("format", std::int64_t{99});
    later.set("version", std::string("7.0"));
    later.save();
    CHECK(message("later.h5").find("checkpoint of format 99") != std::string::npos);
    CHECK(message("later.h5").find("(7.0)") != std::string::npos);
  }

  TEST_CASE("checkpoint: blobs that contradict themselves are errors of the program") {
    const TemporaryFolder folder;
    ResultsFolder results(folder / "run");
    const auto write = [&](CheckpointBlob blob) { results.write_checkpoint({{std::move(blob)}}); };
    CHECK_THROWS_AS(write({"a", {3}, {1, 2}, {}, {}}), std::invalid_argument);
    CHECK_THROWS_AS(write({"a", {}, {1}, {1}, {}}), std::invalid_argument);
    CHECK_THROWS_AS(write({"", {}, {1}, {}, {}}), std::invalid_argument);
    CHECK_THROWS_AS(results.write_checkpoint({{{"a", {}, {1}, {}, {}}, {"a", {}, {1}, {}, {}}}}),
                    OutputError);
    CHECK_FALSE(std::filesystem::exists(folder / "run/checkpoint.h5"));
  }
}
