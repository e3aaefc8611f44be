// SPDX-License-Identifier: Apache-2.0
#include "kontur/suggest.h"

#include "kontur/evidence.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "kontur/sureness/uncertainty_map.h"

namespace kontur {

PlaneSuggestions suggest_planes(const Segmentation& segmentation, const ContourSet& contours, std::size_t count,
                                const SuggestPlaneOptions& options, const Work& work) {
    return suggest_planes(gather_evidence(segmentation, contours, work), contours, count, options, work);
}

std::vector<double> half_widths_mm(const Segmentation& segmentation, const ContourSet& contours,
                                   const std::vector<Vec3>& points, const Work& work) {
    return half_widths_mm(gather_evidence(segmentation, contours, work), points, work);
}

Image uncertainty_map(const Segmentation& segmentation, const ContourSet& contours, const Work& work) {
    return uncertainty_map(segmentation.mask, gather_evidence(segmentation, contours, work), work);
}

}  // namespace kontur
