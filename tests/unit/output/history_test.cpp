// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "krater/core/errors.hpp"
#include "krater/output/results.hpp"
#include "output/hdf5_file.hpp"
#include "output_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

std::vector<Quantity> row(double time, double energy) {
  return {{"time", "s", time}, {"kinetic_energy", "J", energy}, {"step", "", 7}};
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("history: header with units, numbers that read back exactly, readable at any time") {
    const TemporaryFolder folder;
    ResultsFolder results(folder / "run");
    results.write_history(row(0, 1));
    CHECK(read_file(folder / "run/history.csv") == "time [s],kinetic_energy [J],step\n0,1,7\n");
    results.write_history(row(0.1, 1.0 / 3));
    CHECK(read_file(folder / "run/history.csv") ==
          "time [s],kinetic_energy [J],step\n0,1,7\n0.10000000000000001,0.33333333333333331,7\n");
  }

  TEST_CASE("history: history.h5 is the same table after a flush") {
    const TemporaryFolder folder;
    ResultsFolder results(folder / "run");
    results.write_history(row(0, 1));
    results.write_history(row(0.1, std::numeric_limits<double>::quiet_NaN()));
    results.flush();
    const auto file = output::open_file(folder / "run/history.h5");
    CHECK(file.open_dataset("time").read<double>() == std::vector<double>{0, 0.1});
    CHECK(std::isnan(file.open_dataset("kinetic_energy").read<double>()[1]));
    CHECK(file.open_dataset("kinetic_energy").text("unit") == "J");
  }

  TEST_CASE("history: a restart continues the table, without half lines and later rows") {
    const TemporaryFolder folder;
    {
      ResultsFolder results(folder / "run");
      for (int i = 0; i < 5; ++i) results.write_history(row(0.1 * i, i));
    }
    const std::string whole = read_file(folder / "run/history.csv");
    write_file(folder / "run/history.csv", whole + "0.5,3");  // power failed in mid-line
    {
      ResultsFolder results(folder / "run", true);
      results.continue_from(0.1 * 2, row(0, 0));
      for (int i = 3; i < 5; ++i) results.write_history(row(0.1 * i, i));
    }
    CHECK(read_file(folder / "run/history.csv") == whole);
    CHECK(output::open_file(folder / "run/history.h5").open_dataset("time").read<double>().size() ==
          5);
  }

  TEST_CASE("history: a half line goes even when no later row is dropped") {
    const TemporaryFolder folder;
    { ResultsFolder(folder / "run").write_history(row(0, 1)); }
    const std::string whole = read_file(folder / "run/history.csv");
    write_file(folder / "run/history.csv", whole + "0.5,3");
    ResultsFolder(folder / "run", true).write_history(row(0.25, 1));
    CHECK(read_file(folder / "run/history.csv") == whole + "0.25,1,7\n");
  }

  TEST_CASE("history: other columns or a foreign file are refused") {
    const TemporaryFolder folder;
    {
      ResultsFolder results(folder / "run");
      results.write_history(row(0, 1));
      CHECK_THROWS_AS(results.write_history({{"time", "s", 1}}), std::invalid_argument);
      CHECK_THROWS_AS(results.write_history({}), std::invalid_argument);
    }
    CHECK_THROWS_AS(ResultsFolder(folder / "run", true).continue_from(1, {{"time", "s", 1}}),
                    InputError);
    write_file(folder / "run/history.csv", "a,b\n1,hello\n");
    ResultsFolder results(folder / "run", true);
    CHECK_THROWS_AS(results.write_history(row(1, 1)), InputError);
    ResultsFolder other(folder / "other");
    CHECK_THROWS_AS(other.write_history({{"a,b", "s", 1}}), std::invalid_argument);
  }
}
