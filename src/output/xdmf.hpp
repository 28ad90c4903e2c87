// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file output/xdmf.hpp
/// XDMF 3 description of the frames: a temporal collection of frames, in each one grid
/// per body: Polyvertex, or the cells of its mesh, with the fields of its points at the cells.
/// Paths are relative to the folder of frames.xmf.
#include <string>
#include <string_view>
#include <vector>

#include "krater/output/results.hpp"

namespace krater::output {

/// The <Grid> of one frame whose arrays are in `file`.
std::string frame_grid(const OutputFrame& frame, const std::string& file);

/// The document is kXdmfHead, the <Grid> of every frame, kXdmfTail.
inline constexpr std::string_view kXdmfHead =
    "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
    "  <Grid Name=\"frames\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
inline constexpr std::string_view kXdmfTail = "  </Grid>\n  </Domain>\n</Xdmf>\n";

/// A frame's <Grid> in a document.
struct ListedFrame {
  int number = 0;
  double time = 0;
  std::size_t begin = 0, end = 0;  ///< bytes of the document
};

/// The whole frames of a document as krater writes them, up to the first that is not.
std::vector<ListedFrame> listed_frames(const std::string& document);

}  // namespace krater::output
