// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/frames.hpp
/// The frames of a run: one file per frame, never touched again, and two small files that list them
/// and grow by what a frame adds, so that a frame costs the same whatever their number. A run that
/// is continued reads frames.xmf, which is text: it opens no HDF5 file of an earlier run.
#include <optional>
#include <string>
#include <vector>

#include "krater/output/results.hpp"
#include "output/hdf5_file.hpp"
#include "output/xdmf.hpp"

namespace krater::output {

class FrameSeries {
 public:
  explicit FrameSeries(std::string folder) : folder_(std::move(folder)) {}

  void remove_all();  ///< files of an earlier run, and half-written ones
  void load();        ///< the frames of an earlier run that is continued
  void truncate_after(double time, const TextAttributes& attributes);
  /// A frame that is written, but for waiting until it is on disk and in the lists.
  struct Written {
    StreamedFile file;
    int number;
    double time;
    std::string grid;  ///< its part of frames.xmf
  };
  Written write(const OutputFrame& frame, const TextAttributes& attributes) const;
  void commit(Written frame, const TextAttributes& attributes);

 private:
  std::string list() const { return folder_ + "/frames.xmf"; }
  std::size_t end_of_list() const;
  void save_links(const TextAttributes& attributes);  ///< frames.h5
  std::string folder_;
  std::vector<ListedFrame> frames_;  ///< in order of time
  std::optional<MemoryFile> links_;  ///< frames.h5 as it is
  std::size_t linked_ = 0;           ///< frames in it
};

}  // namespace krater::output
