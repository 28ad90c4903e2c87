// SPDX-License-Identifier: GPL-3.0-or-later
// What output/packing.hpp packs, HDF5's own filters unpack.
#include <doctest/doctest.h>

#include <bit>
#include <vector>

#include "krater/core/parallel.hpp"
#include "krater/output/results.hpp"
#include "output/hdf5_file.hpp"
#include "output/packing.hpp"
#include "output_support.hpp"

using namespace krater;
using namespace krater::test;

namespace {

std::uint64_t next(std::uint64_t& x) {
  x ^= x << 13, x ^= x >> 7, x ^= x << 17;
  return x;
}

/// Fields as they are: zeros, one value, a smooth field, and bits that no packing makes shorter.
std::vector<double> field_of(int kind, std::size_t count) {
  std::vector<double> values(count);
  std::uint64_t x = 88172645463325252;
  for (std::size_t i = 0; i < count; ++i)
    values[i] = kind == 0   ? 0.0
                : kind == 1 ? 8960.0
                : kind == 2 ? 1e9 / (1.0 + static_cast<double>(i))
                            : std::bit_cast<double>(next(x));
  return values;
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double v : values) bits.push_back(std::bit_cast<std::uint64_t>(v));
  return bits;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("packing: any HDF5 reads what was packed, to the last bit") {
    const TemporaryFolder folder;
    const int before = set_threads(3);
    for (const std::size_t points : {0U, 1U, 127U, 128U, 10922U, 10923U, 65537U, 200001U})
      for (const int width : {1, 6})
        for (int kind = 0; kind < 4; ++kind) {
          if (points > 20000 && width == 6 && kind != 3) continue;
          CAPTURE(points);
          CAPTURE(width);
          CAPTURE(kind);
          const auto w = static_cast<std::size_t>(width);
          const std::vector<double> values = field_of(kind, points * w);
          output::StreamedFile file(folder / "packed.h5");
          const output::Shape shape = width == 1 ? output::Shape{points} : output::Shape{points, w};
          file.make_packed<double>("a", shape, rows_of(values, width));
          file.close();
          file.commit();
          const output::Node read = output::open_file(folder / "packed.h5");
          CHECK(read.open_dataset("a").shape() == shape);
          CHECK(bits_of(read.open_dataset("a").read<double>()) == bits_of(values));
        }
    set_threads(before);
  }

  TEST_CASE("packing: integers, and a matrix row by row") {
    const TemporaryFolder folder;
    std::vector<std::int64_t> numbers(70000);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      numbers[i] = static_cast<std::int64_t>(i) - 35000;
    const std::vector<double> matrix = field_of(3, 7 * 1000);
    output::StreamedFile file(folder / "mixed.h5", output::StreamedFile::Kind::sealed);
    file.make_packed<std::int64_t>("numbers", {numbers.size()}, rows_of(numbers));
    file.make_matrix("matrix", {7, 1000}, rows_of(matrix, 1000));
    file.close();
    file.commit();
    const output::Node read = output::open_file(folder / "mixed.h5");
    CHECK(read.open_dataset("numbers").read<std::int64_t>() == numbers);
    CHECK(bits_of(read.open_dataset("matrix").read<double>()) == bits_of(matrix));
    std::vector<double> rows(2000);
    read.open_dataset("matrix").read_rows(3, 2, rows.data());
    CHECK(bits_of(rows) == bits_of({matrix.begin() + 3000, matrix.begin() + 5000}));
  }

  TEST_CASE("packing: smooth fields take less room, noise hardly more") {
    output::Packer packer;
    const auto share = [&](int kind) {
      const std::vector<std::uint64_t> words = bits_of(field_of(kind, 1 << 16));
      const auto packed = packer.pack(words);
      return static_cast<double>(packed.bytes.size()) / (8.0 * (1 << 16));
    };
    CHECK(share(0) < 0.02);
    CHECK(share(1) < 0.02);
    CHECK(share(2) < 0.9);
    CHECK(share(3) <= 1.0);
  }

  TEST_CASE("a file that is not committed leaves nothing behind") {
    const TemporaryFolder folder;
    write_file(folder / "old.h5", "what was there");
    {
      output::StreamedFile file(folder / "old.h5");
      file.set("name", std::string("new"));
    }
    CHECK(read_file(folder / "old.h5") == "what was there");
    CHECK_FALSE(std::filesystem::exists(folder / "old.h5.part"));
  }
}
