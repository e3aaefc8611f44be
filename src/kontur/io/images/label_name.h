// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace kontur {

/// What a file says of the voxels of one value. Formats keep what they have room for: .seg.nrrd all of it, NIfTI name and
/// colour in a table of labels, others the value alone.
struct LabelName {
    std::int64_t label = 1;  ///< the value
    std::string name = "Segment_1";
    std::array<double, 3> color{0.9, 0.7, 0.3};  ///< red, green, blue from 0 to 1
    std::string tags{};  ///< of 3D Slicer, NAME:VALUE with bars between them; "TerminologyEntry" says what it is
};

}  // namespace kontur
