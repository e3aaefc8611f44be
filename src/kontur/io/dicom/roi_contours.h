// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: what the stored contours of a ROI mean (DICOM PS3.3 C.8.8.6).

#include <optional>
#include <string>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// A contour as it stands in the file.
struct StoredContour {
    std::string type;  ///< ContourGeometricType: "CLOSED_PLANAR", "POINT", ...
    std::vector<Vec3> points;
    std::optional<std::size_t> frame{};  ///< to whose slices alone it refers, from 0
};

struct InterpretedContours {
    std::vector<Contour> contours;
    std::vector<SurfacePoint> surface;
    std::vector<std::string> notes;
};

/// See `read_rtstruct` for the rules.
InterpretedContours interpret_contours(const std::vector<StoredContour>& stored);

}  // namespace kontur
