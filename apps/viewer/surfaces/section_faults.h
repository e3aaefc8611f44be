// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/measure/section_faults.h"
#include "viewer/model/model.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {

/// Where a surface is not as it was drawn.
struct SurfaceFault {
    SectionFaultKind kind = SectionFaultKind::missing;
    Vec3 at;
    std::vector<Id> contours;
    double share = 0, length_mm = 0;  ///< as those of a SectionFault
};

/// Those of a check whose contour `i` has the id `ids[i]`, of each kind at most ten.
std::vector<SurfaceFault> surface_faults(const SectionCheck& check, const std::vector<Id>& ids);

nlohmann::json to_json(const std::vector<SurfaceFault>& faults);

}  // namespace kontur::viewer
