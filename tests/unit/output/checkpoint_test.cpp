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
    for (std::size_t length = 0; length < bytes.size(); length += length < 600 ? 1 : 37) {
      write_file(cut, bytes.substr(0, length));
      CAPTURE(length);
      CHECK(message_of<InputError>([&] { read_checkpoint(cut); }).find("cut short") !=
            std::string::npos);
    }
    write_file(cut, bytes + '\0');
    CHECK_THROWS_AS(read_checkpoint(cut), InputError);
  }

  TEST_CASE("checkpoint: any one flipped bit is noticed before HDF5 sees the file") {
    const TemporaryFolder folder;
    const std::string path = save(folder, small_checkpoint()), whole = read_file(path);
    for (std::size_t bit = 0; bit < 8 * whole.size(); bit += bit < 4096 ? 1 : 61) {
      std::string bytes = whole;
      bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
      write_file(path, bytes);
      CAPTURE(bit);
      CHECK(message_of<InputError>([&] { read_checkpoint(path); }).find("damaged") !=
            std::string::npos);
    }
  }

  TEST_CASE("checkpoint: two flipped bits of the same weight do not hide one another") {
    const TemporaryFolder folder;
    const std::string path = save(folder, {{{"x", {}, std::vector<double>(64, 1.0), {}, {}}}});
    const std::string whole = read_file(path);
    const double one = 1;
    const std::size_t at = whole.find(std::string(reinterpret_cast<const char*>(&one), sizeof one));
    REQUIRE(at != std::string::npos);
    for (std::size_t other = 1; other < 64; ++other) {
      std::string bytes = whole;
      for (const std::size_t place : {at + 7, at + 7 + 8 * other})
        bytes[place] = static_cast<char>(bytes[place] ^ 0x80);
      write_file(path, bytes);
      CHECK_THROWS_AS(read_checkpoint(path), InputError);
    }
  }

  TEST_CASE("checkpoint: the number of names has no limit") {
    const TemporaryFolder folder;
    Checkpoint checkpoint;
    for (int i = 0; i < 5000; ++i)
      checkpoint.blobs.push_back(
          {"a body with a long name " + std::to_string(i), {}, {1.0 * i}, {}, {}});
    const Checkpoint read = read_checkpoint(save(folder, checkpoint));
    REQUIRE(read.blobs.size() == 5000);
    CHECK(read.blobs[4321].name == checkpoint.blobs[4321].name);
    CHECK(read.blobs[4321].doubles == std::vector<double>{4321});
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
    CHECK(message("text.h5").find("not a checkpoint of krater") != std::string::npos);

    output::MemoryFile plain(folder / "plain.h5");  // a frame, or what krater 0.1 wrote
    plain.set("magic", std::string("krater checkpoint"));
    plain.save();
    CHECK(message("plain.h5").find("one of format 1") != std::string::npos);

    std::string later = read_file(save(folder, small_checkpoint()));
    later[later.find("format 3") + 7] = '4';
    write_file(folder / "later.h5", later);
    CHECK(message("later.h5").find("of another format than 3") != std::string::npos);
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
