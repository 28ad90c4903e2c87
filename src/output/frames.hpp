// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/frames.hpp
/// The frames of a run: one file per frame, never touched again, and two small files that list
/// them.
#include <map>
#include <string>

#include "krater/output/results.hpp"

namespace krater::output {

class FrameSeries {
 public:
  explicit FrameSeries(std::string folder) : folder_(std::move(folder)) {}

  void remove_all();  ///< files of an earlier run, and half-written ones
  void load();        ///< the frames of an earlier run that is continued
  void truncate_after(double time, const TextAttributes& attributes);
  void write(const OutputFrame& frame, const TextAttributes& attributes);

 private:
  void write_index(const TextAttributes& attributes) const;
  std::string folder_;
  std::map<int, std::string> grids_;  ///< XDMF of every frame
  std::map<int, double> times_;
};

}  // namespace krater::output
