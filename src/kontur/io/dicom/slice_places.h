// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace kontur {

/// Where a slice of a file lies.
struct SlicePlace {
    std::int64_t frame = 1;  ///< of the file, from 1
    double along_normal_mm = 0;
};

/// Of all slices in a DICOM file, from its header: for who shows them before their series is whole. None for what is no
/// image, or damaged. Throws Error(io).
std::vector<SlicePlace> slice_places(const std::filesystem::path& file);

}  // namespace kontur
