// SPDX-License-Identifier: GPL-3.0-or-later
#include "verification/run_support.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace krater::test {

namespace {

/// A file that goes away with its owner.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() /
            ("krater_test_" + std::to_string(getpid()) + "_" + std::to_string(count++) + ".yaml");
    std::ofstream{path_} << text;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::unique_ptr<const Scene> read_file(const std::string& file, const Overrides& overrides) {
  Overrides all{"time.energy_error=off"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return std::make_unique<const Scene>(read_scene(file, all));
}

Run start(const std::string& file, const Overrides& overrides, IsaLevel level) {
  Run run;
  run.scene = read_file(file, overrides);
  run.sim = std::make_unique<Simulation>(*run.scene, level);
  return run;
}

int slot_of(const Run& run, const FieldInfo& field, int component, int body) {
  return run.sim->bodies()[static_cast<std::size_t>(body)]->slot(field, component);
}

}  // namespace

std::unique_ptr<const Scene> read_text(const std::string& yaml, const Overrides& overrides) {
  const TemporaryFile file{yaml};
  return read_file(file.path(), overrides);
}

Run start_text(const std::string& yaml, const Overrides& overrides, IsaLevel level) {
  const TemporaryFile file{yaml};
  return start(file.path(), overrides, level);
}

Run start_input(const std::string& name, const Overrides& overrides, IsaLevel level) {
  return start(std::string{KRATER_SOURCE_DIR} + "/inputs/" + name, overrides, level);
}

void run_to(Run& run, double time) {
  while (run.sim->time() < time) run.sim->step(time);
}

void run_steps(Run& run, int steps) {
  for (int i = 0; i < steps; ++i) run.sim->step(1e300);
}

std::vector<double> column(const Run& run, const FieldInfo& field, int component, int body) {
  const int slot = slot_of(run, field, component, body);
  std::vector<double> out;
  if (slot < 0) return out;
  for (const auto& [patch, point] : run.sim->points_by_id(body))
    out.push_back(run.sim->value(patch, point, slot));
  return out;
}

void set_column(Run& run, const FieldInfo& field, int component, const std::vector<double>& values,
                int body) {
  const int slot = slot_of(run, field, component, body);
  if (slot < 0) throw std::logic_error(std::string{"no column "} + field.name);
  std::size_t i = 0;
  for (const auto& [patch, point] : run.sim->points_by_id(body))
    run.sim->set_value(patch, point, slot, values.at(i++));
  run.sim->book_change();
}

namespace {

std::vector<double> matrix_of(const CheckpointBlob& blob) {
  if (!blob.matrix) return {};
  std::vector<double> values(blob.shape.at(0) * blob.shape.at(1));
  if (!values.empty()) blob.matrix(0, blob.shape[0], values.data());
  return values;
}

}  // namespace

Checkpoint saved_state(const Simulation& sim) {
  Checkpoint state = sim.save();
  for (CheckpointBlob& blob : state.blobs) {
    if (!blob.matrix) continue;
    blob.matrix = [values = matrix_of(blob), width = blob.shape[1]](
                      std::size_t first, std::size_t count, double* out) {
      std::copy_n(values.data() + first * width, count * width, out);
    };
  }
  return state;
}

std::vector<std::uint64_t> all_bits(const Simulation& sim) {
  std::vector<std::uint64_t> bits;
  for (const CheckpointBlob& blob : sim.save().blobs) {
    for (const double x : matrix_of(blob)) bits.push_back(std::bit_cast<std::uint64_t>(x));
    for (const double x : blob.doubles) bits.push_back(std::bit_cast<std::uint64_t>(x));
    for (const std::int64_t x : blob.integers) bits.push_back(static_cast<std::uint64_t>(x));
  }
  return bits;
}

double energy_residual(const Run& run) {
  const Totals now = run.sim->totals();
  return run.sim->audit().residual(now.kinetic, now.internal);
}

std::vector<std::vector<std::string>> read_table(const std::string& name) {
  const std::string path = std::string{KRATER_SOURCE_DIR} + "/tests/data/" + name;
  std::ifstream file{path};
  if (!file) throw std::runtime_error("cannot read " + path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> row(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"')
        quoted = !quoted;
      else if (c == ',' && !quoted)
        row.emplace_back();
      else
        row.back() += c;
    }
    rows.push_back(row);
  }
  return rows;
}

double observed_order(const std::vector<double>& h, const std::vector<double>& error) {
  return std::log(error.front() / error.back()) / std::log(h.front() / h.back());
}

}  // namespace krater::test
