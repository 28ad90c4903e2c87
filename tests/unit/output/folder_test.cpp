// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>

#include "krater/core/errors.hpp"
#include "krater/output/results.hpp"
#include "output/hdf5_file.hpp"
#include "output_support.hpp"

using namespace krater;
using namespace krater::test;
namespace fs = std::filesystem;

namespace {

/// Files of this process end at `size` bytes, as on a full disk.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t size) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{size, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SizeLimit(const SizeLimit&) = delete;
  SizeLimit& operator=(const SizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("results: the folder appears with the first file, not before") {
    const TemporaryFolder folder;
    {
      ResultsFolder results(folder / "a/b");
      results.set_attributes({{"program", "krater"}});
      results.flush();
    }
    CHECK_FALSE(fs::exists(folder / "a"));
    ResultsFolder results(folder / "a/b/");
    CHECK(results.path() == folder / "a/b");
    results.write_text("resolved.yaml", "title: x\n");
    CHECK(read_file(folder / "a/b/resolved.yaml") == "title: x\n");
    CHECK_THROWS_AS(results.write_text("../escape", ""), std::invalid_argument);
  }

  TEST_CASE("results: a folder that cannot be made is the user's to mend") {
    const TemporaryFolder folder;
    write_file(folder / "file", "");
    for (const std::string& path : {folder / "file", folder / "file/run"}) {
      ResultsFolder results(path);
      CHECK(message_of<InputError>([&] { results.write_text("log.txt", ""); }) ==
            path + ": results folder cannot be created: Not a directory");
    }
    CHECK_THROWS_AS(ResultsFolder(""), InputError);
  }

  TEST_CASE("results: a fresh run removes the files of an earlier one and no others") {
    const TemporaryFolder folder;
    {
      ResultsFolder results(folder / "run");
      results.write_frame(small_frame(0, 0));
      results.write_frame(small_frame(5, 1));
      results.write_history({{"time", "s", 0}});
      results.write_checkpoint({{{"a", {}, {1}, {}, {}}}});
      results.write_summary(Json{});
    }
    write_file(folder / "run/frames/000006.h5.part", "half");
    write_file(folder / "run/frames/mine.h5", "mine");
    write_file(folder / "run/notes.txt", "mine");
    ResultsFolder results(folder / "run");
    results.write_frame(small_frame(0, 0));
    results.wait();
    std::vector<std::string> left;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "run")) {
      if (entry.is_regular_file()) left.push_back(entry.path().filename().string());
    }
    std::sort(left.begin(), left.end());
    CHECK(left ==
          std::vector<std::string>{"000000.h5", "frames.h5", "frames.xmf", "mine.h5", "notes.txt"});
    CHECK(read_file(folder / "run/frames/mine.h5") == "mine");
  }

  TEST_CASE("results: a full disk is an exception with file and reason, earlier files stay") {
    const TemporaryFolder folder;
    ResultsFolder results(folder / "run");
    results.write_checkpoint({{{"a", {}, {1, 2, 3}, {}, {}}}});
    results.write_frame(small_frame(0, 0));
    results.wait();
    results.write_history({{"time", "s", 0}});
    const Checkpoint large{{{"a", {}, std::vector<double>(100000, 1.0), {}, {}}}};
    for (const rlim_t size : {0u, 5u, 100u, 5000u, 200000u}) {
      const SizeLimit limit(size);
      CHECK(message_of<OutputError>([&] { results.write_checkpoint(large); }) ==
            (folder / "run/checkpoint.h5") + ": cannot be written: File too large");
    }
    {
      const SizeLimit limit(12);  // the history has 11 bytes
      results.write_frame(small_frame(1, 1));
      CHECK_THROWS_AS(results.wait(), OutputError);
      CHECK_THROWS_AS(results.write_history({{"time", "s", 0.125}}), OutputError);
    }
    CHECK(read_checkpoint(folder / "run/checkpoint.h5").blobs[0].doubles.size() == 3);
    CHECK(read_file(folder / "run/history.csv") == "time [s]\n0\n");
    CHECK(output::open_file(folder / "run/frames.h5")
              .open_dataset("frames/000000/rod/pressure")
              .shape() == output::Shape{2});
    for (const auto& entry : fs::recursive_directory_iterator(folder / "run")) {
      CHECK(entry.path().extension() != ".part");
    }
    results.write_checkpoint(large);  // and it goes on when there is room again
    CHECK(read_checkpoint(folder / "run/checkpoint.h5").blobs[0].doubles.size() == 100000);
  }
}
