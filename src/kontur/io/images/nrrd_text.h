// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: the header of an NRRD file that is written.

#include <cstddef>
#include <string>
#include <string_view>

#include "kontur/io/images/nrrd.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/provenance.h"

namespace kontur {

/// All lines but what is said of segments and the empty one at the end. More than one layer are an axis before those of
/// space.
std::string nrrd_header_text(const Grid& grid, std::string_view type, std::size_t layers, const Provenance& provenance);

/// What is said of all segments together.
std::string segmentation_keys();

/// What is said of one segment; `extent` are its first and last index along each axis, "0 -1" for none.
std::string segment_keys(std::size_t number, const NrrdSegment& segment, const std::string& extent);

}  // namespace kontur
