// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/output/results.hpp"

#include <filesystem>
#include <future>
#include <string_view>
#include <system_error>

#include "krater/core/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/checkpoint.hpp"
#include "output/frames.hpp"
#include "output/history.hpp"
#include "output/table.hpp"

namespace krater {

namespace fs = std::filesystem;

struct ResultsFolder::Impl {
  Impl(std::string folder, bool continued)
      : path(std::move(folder)), resume(continued), frames(path), history(path) {}

  /// Before the first file is written: makes the folder, and clears or reads what an earlier run
  /// left.
  void prepare() {
    if (ready) return;
    std::error_code error;
    fs::create_directories(path, error);
    if (error || !fs::is_directory(path)) {
      const std::string why = error ? error.message() : "not a folder";
      throw InputError(path + ": results folder cannot be created: " + why);
    }
    if (resume) {
      frames.load();
      history.load();
    } else {
      frames.remove_all();
      history.remove_all();
      for (const char* name :
           {"checkpoint.h5", "summary.json", "point.csv", "point.h5", "log.txt"}) {
        fs::remove(path + "/" + name, error);
        fs::remove(path + "/" + name + output::kPartSuffix, error);
      }
      remove_gauges();
    }
    ready = true;
  }

  /// Also those that this scene has no more.
  void remove_gauges() const {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator{path}) {
      std::string name = entry.path().filename().string();
      if (name.ends_with(output::kPartSuffix))
        name.resize(name.size() - std::string_view{output::kPartSuffix}.size());
      if (name.starts_with(output::kGauge) && (name.ends_with(".csv") || name.ends_with(".h5")))
        found.push_back(entry.path());
    }
    std::error_code error;
    for (const fs::path& file : found) fs::remove(file, error);
  }

  std::string path;
  bool resume;
  bool ready = false;
  TextAttributes attributes;
  output::FrameSeries frames;
  output::History history;
  output::LineAppender log;
  std::future<void> frame;  ///< last: its thread ends before what it uses
};

ResultsFolder::ResultsFolder(std::string path, bool resume) {
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  if (path.empty()) throw InputError("results folder: empty name");
  impl_ = std::make_unique<Impl>(std::move(path), resume);
}

ResultsFolder::~ResultsFolder() {
  try {
    flush();
  } catch (const std::exception&) {
    // Nobody is left to tell; whoever wants to know has called flush(). history.csv is complete.
  }
}

const std::string& ResultsFolder::path() const { return impl_->path; }

void ResultsFolder::set_attributes(TextAttributes attributes) {
  wait();
  impl_->attributes = std::move(attributes);
}

void ResultsFolder::continue_from(double time, const std::vector<Quantity>& row) {
  wait();
  impl_->prepare();
  impl_->history.require_columns(row);
  impl_->frames.truncate_after(time, impl_->attributes);
  impl_->history.truncate_after(time);
}

void ResultsFolder::wait() {
  if (impl_->frame.valid()) impl_->frame.get();
}

void ResultsFolder::write_frame(const OutputFrame& frame) {
  wait();
  impl_->prepare();
  impl_->frame = std::async(
      std::launch::async,
      [impl = impl_.get(), written = impl_->frames.write(frame, impl_->attributes)]() mutable {
        impl->frames.commit(std::move(written), impl->attributes);
      });
}

void ResultsFolder::write_history(const std::vector<Quantity>& row) {
  impl_->prepare();
  impl_->history.append(row);
}

void ResultsFolder::write_checkpoint(const Checkpoint& checkpoint) {
  wait();
  impl_->prepare();
  output::save_checkpoint(impl_->path + "/checkpoint.h5", checkpoint, impl_->attributes);
}

void ResultsFolder::write_table(const std::string& name, const std::vector<TableColumn>& columns) {
  wait();
  impl_->prepare();
  output::save_table(impl_->path + "/" + name, columns, impl_->attributes);
}

void ResultsFolder::write_gauge(SeriesTable table) {
  wait();
  impl_->prepare();
  output::save_csv(impl_->path + "/" + output::kGauge + table.name, table.columns);
  impl_->history.set_series(std::move(table));
}

void ResultsFolder::write_summary(const Json& summary) {
  impl_->prepare();
  output::replace_file(impl_->path + "/summary.json", to_text(summary));
}

void ResultsFolder::write_text(const std::string& name, const std::string& text) {
  if (name.empty() || name.find('/') != std::string::npos) {
    throw std::invalid_argument("results: '" + name + "' is not the name of a file");
  }
  impl_->prepare();
  output::replace_file(impl_->path + "/" + name, text);
}

void ResultsFolder::write_log(const std::string& line) {
  try {
    impl_->prepare();
    if (!impl_->log.is_open()) impl_->log.open(impl_->path + "/log.txt");
    impl_->log.append(line + "\n");
  } catch (const std::exception&) {
    // The next file that cannot be written says why.
  }
}

void ResultsFolder::flush() {
  wait();
  if (impl_->ready) impl_->history.save_copy(impl_->attributes);
}

}  // namespace krater
