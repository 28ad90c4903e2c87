// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "krater/output/results.hpp"
#include "output/hdf5_file.hpp"
#include "output_support.hpp"

using namespace krater;
using namespace krater::test;
using output::open_file;
namespace fs = std::filesystem;

namespace {

std::vector<double> pressure(const std::string& file, const std::string& frame) {
  return open_file(file).open_dataset("frames/" + frame + "/rod/pressure").read<double>();
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

}  // namespace

TEST_SUITE("unit") {
  TEST_CASE("frames: a mesh is written as cells, with fields at cells and at nodes") {
    const TemporaryFolder folder;
    OutputFrame frame = small_frame(0, 0);
    frame.bodies.front().mesh = FrameMesh{
        .nodes = 6,
        .corners = 4,
        .connectivity = rows_of<std::int64_t>({0, 1, 4, 3, 1, 2, 5, 4}, 4),
        .coordinates = rows_of<double>({0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 0, 1, 1, 0, 1, 2, 0, 1}, 3),
        .fields = {{"mass", "kg", "mass", 1, {}, rows_of<double>({1, 2, 3, 4, 5, 6})}}};
    ResultsFolder results(folder / "run");
    results.write_frame(frame);
    results.wait();
    const auto file = open_file(folder / "run/frames.h5");
    const std::string rod = "frames/000000/rod/";
    CHECK(file.open_dataset(rod + "connectivity").read<std::int64_t>() ==
          std::vector<std::int64_t>{0, 1, 4, 3, 1, 2, 5, 4});
    CHECK(file.open_dataset(rod + "nodes/coordinates").read<double>()[15] == 2);
    CHECK(file.open_dataset(rod + "nodes/mass").read<double>() ==
          std::vector<double>{1, 2, 3, 4, 5, 6});
    const std::string xmf = read_file(folder / "run/frames.xmf");
    CHECK(occurrences(xmf, "TopologyType=\"Quadrilateral\" NumberOfElements=\"2\"") == 1);
    CHECK(occurrences(xmf, "Polyvertex") == 0);
    CHECK(occurrences(xmf, "Dimensions=\"6 3\">frames/000000.h5:/rod/nodes/coordinates") == 1);
    CHECK(occurrences(xmf, "Name=\"mass\" AttributeType=\"Scalar\" Center=\"Node\"") == 1);
    CHECK(occurrences(xmf, "Name=\"pressure\" AttributeType=\"Scalar\" Center=\"Cell\"") == 1);
    frame.bodies.front().mesh->corners = 6;
    CHECK(message_of<std::invalid_argument>([&] {
            results.write_frame(frame);
          }).find("cells of no known kind") != std::string::npos);
  }

  TEST_CASE("frames: values, units and components are found through frames.h5") {
    const TemporaryFolder folder;
    ResultsFolder results(folder / "run");
    results.set_attributes({{"program", "krater"}, {"frame_of_reference", "axisymmetric"}});
    results.write_frame(small_frame(3, 1.5e-6));
    results.wait();
    const auto file = open_file(folder / "run/frames.h5");
    CHECK(file.text("frame_of_reference") == "axisymmetric");
    const std::string rod = "frames/000003/rod/";
    CHECK(file.open_dataset(rod + "pressure").read<double>() == std::vector<double>{10, 20});
    CHECK(file.open_dataset(rod + "pressure").text("unit") == "Pa");
    CHECK(file.open_dataset(rod + "id").read<std::int64_t>() == std::vector<std::int64_t>{3, 7});
    CHECK(file.open_dataset(rod + "coordinates").shape() == output::Shape{2, 3});
    const auto frame = open_file(folder / "run/frames/000003.h5");
    CHECK(frame.number("time") == 1.5e-6);
    CHECK(frame.integer("step") == 300);
  }

  TEST_CASE("frames: arrays of any number of components are stored as they come") {
    const TemporaryFolder folder;
    ResultsFolder results(folder / "run");
    results.write_frame(small_frame(0, 0));
    results.wait();
    const auto file = open_file(folder / "run/frames/000000.h5");
    const auto velocity = file.open_dataset("rod/velocity");
    CHECK(velocity.read<double>() == std::vector<double>{1, 0, 2, 3, 0, 4});
    CHECK(velocity.texts("component_names") == std::vector<std::string>{"r", "t", "z"});
    const auto stress = file.open_dataset("rod/stress");
    CHECK(stress.shape() == output::Shape{2, 6});
    CHECK(stress.read<double>() == std::vector<double>{1, 2, 3, 4, 5, 6, 11, 12, 13, 14, 15, 16});
    CHECK(stress.texts("component_names") ==
          std::vector<std::string>{"xx", "yy", "zz", "yz", "xz", "xy"});
    CHECK(file.open_dataset("rod/affine_velocity").shape() == output::Shape{2, 4});
  }

  TEST_CASE("frames: frames.xmf lists every frame with its time, bodies and arrays") {
    const TemporaryFolder folder;
    ResultsFolder results(folder / "run");
    OutputFrame frame = small_frame(0, 0);
    frame.bodies[0].body = "a<b";
    frame.bodies.push_back({"gone",
                            0,
                            rows_of<std::int64_t>({}),
                            rows_of<double>({}),
                            {{"pressure", "Pa", "", 1, {}, rows_of<double>({})}}});
    results.write_frame(frame);
    results.write_frame(small_frame(1, 0.1));
    results.wait();
    const std::string text = read_file(folder / "run/frames.xmf");
    CHECK(text.find("<Time Value=\"0.10000000000000001\"/>") != std::string::npos);
    CHECK(text.find("Name=\"a&lt;b\"") != std::string::npos);
    CHECK(text.find("gone") == std::string::npos);  // no points, no grid
    CHECK(text.find(">frames/000001.h5:/rod/stress<") != std::string::npos);
    CHECK(occurrences(text, "Name=\"stress_yz\"") == 2);
    CHECK(text.find(">0 3 1 1 2 1<") != std::string::npos);  // stress_yz is column 3
    CHECK(occurrences(text, "AttributeType=\"Vector\"") == 2);
    CHECK(occurrences(text, "Name=\"affine_velocity_zr\"") == 2);
  }

  TEST_CASE("frames: the same frame is the same bytes") {
    const TemporaryFolder folder;
    ResultsFolder(folder / "a").write_frame(small_frame(0, 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 would keep the second
    ResultsFolder(folder / "b").write_frame(small_frame(0, 1));
    CHECK(read_file(folder / "a/frames/000000.h5") == read_file(folder / "b/frames/000000.h5"));
    CHECK(read_file(folder / "a/frames.h5") == read_file(folder / "b/frames.h5"));
  }

  TEST_CASE("frames: earlier ones are readable when a later one was interrupted") {
    const TemporaryFolder folder;
    {
      ResultsFolder results(folder / "run");
      results.write_frame(small_frame(0, 0));
      results.write_frame(small_frame(1, 1));
    }
    // What a kill leaves: half a frame under its temporary name, or one that is not yet listed.
    const std::string whole = read_file(folder / "run/frames/000001.h5");
    write_file(folder / "run/frames/000002.h5.part", whole.substr(0, whole.size() / 2));
    write_file(folder / "run/frames.h5.part", "half");
    CHECK(pressure(folder / "run/frames.h5", "000001") == std::vector<double>{10, 20});
    {
      ResultsFolder results(folder / "run", true);
      results.write_frame(small_frame(2, 2));
    }
    for (const char* frame : {"000000", "000001", "000002"}) {
      CHECK(pressure(folder / "run/frames.h5", frame) == std::vector<double>{10, 20});
    }
    CHECK_FALSE(fs::exists(folder / "run/frames/000002.h5.part"));
  }

  TEST_CASE("frames: a restart keeps the earlier ones and drops the later ones") {
    const TemporaryFolder folder;
    {
      ResultsFolder results(folder / "run");
      for (int n = 0; n < 4; ++n) results.write_frame(small_frame(n, n));
    }
    const std::string before = read_file(folder / "run/frames.xmf");
    ResultsFolder results(folder / "run", true);
    results.continue_from(1.0, {});
    CHECK(fs::exists(folder / "run/frames/000001.h5"));
    CHECK_FALSE(fs::exists(folder / "run/frames/000002.h5"));
    CHECK(occurrences(read_file(folder / "run/frames.xmf"), "<Time") == 2);
    CHECK(pressure(folder / "run/frames.h5", "000001").size() == 2);
    CHECK_THROWS(pressure(folder / "run/frames.h5", "000002"));
    for (int n = 2; n < 4; ++n) results.write_frame(small_frame(n, n));
    results.wait();
    CHECK(read_file(folder / "run/frames.xmf") == before);
  }

  TEST_CASE("frames: contradictory arrays are errors of the program") {
    const TemporaryFolder folder;
    ResultsFolder results(folder / "run");
    const auto refused = [&](auto change) {
      OutputFrame frame = small_frame(0, 0);
      change(frame.bodies[0]);
      return message_of<std::invalid_argument>([&] {
        results.write_frame(frame);
        results.wait();
      });
    };
    CHECK(refused([](auto& b) { b.fields[0].values = nullptr; }) ==
          "frame: body 'rod': no values of 'pressure'");
    CHECK(refused([](auto& b) { b.coordinates = nullptr; }).find("no ids or coordinates") !=
          std::string::npos);
    CHECK(refused([](auto& b) { b.fields[1].component_names.pop_back(); }).find("names") !=
          std::string::npos);
    CHECK(refused([](auto& b) { b.fields[0].name = "a/b"; }).find("unusable") != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "run/frames/000000.h5"));
  }
}
