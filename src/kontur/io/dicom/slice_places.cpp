// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/slice_places.h"

#include <variant>

#include "kontur/io/dicom/dicom_header.h"

namespace kontur {

std::vector<SlicePlace> slice_places(const std::filesystem::path& file) {
    const auto content = read_dicom_headers(file);
    std::vector<SlicePlace> places;
    if (const auto* headers = std::get_if<std::vector<DicomHeader>>(&content))
        for (const DicomHeader& one : *headers)
            places.push_back({one.frame.value_or(1), dot(one.placement.position, one.placement.normal())});
    return places;
}

}  // namespace kontur
