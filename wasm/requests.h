// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "kontur/fill_labels.h"
#include "kontur/segment_options.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"

// What JavaScript asks for, as JSON: its types are in package/src/types.ts.

namespace kontur::wasm {

/// Contours, and how they become a segmentation.
struct Request {
    ContourSet contours;
    Grid grid;  ///< of the mask
    SegmentOptions options;
};

/// Throws Error(invalid_input), naming the key, for a request that is none, and as parse_contour_json does. All here throw
/// like this.
Request request_from(std::string_view text);

/// Of the label map and the image, and how they are filled.
struct FillRequest {
    Grid grid;
    std::string labels_type, image_type;  ///< of their typed arrays
    FillOptions options;
};
FillRequest fill_request_from(std::string_view text);

Grid grid_from(std::string_view text);

Plane plane_from(std::string_view text);

nlohmann::json to_json(const Grid& grid);

}  // namespace kontur::wasm
