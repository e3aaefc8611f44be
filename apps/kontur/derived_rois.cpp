// SPDX-License-Identifier: Apache-2.0
#include "derived_rois.h"

#include <algorithm>
#include <utility>

#include "derive_outputs.h"
#include "kontur/base/error.h"
#include "kontur/derive/derive.h"
#include "kontur/derive/derived_attributes.h"
#include "rules_file.h"
#include "structures.h"

namespace kontur::app {

void check_roi_derivation(const SegmentCommand& command, const RoiDrawings& drawings) {
    std::vector<std::string> names;
    for (const Roi& roi : drawings.rois) names.push_back(roi.name);
    check_rules(read_rules_file(command.rules), names, drawings.image.has_value());
}

void add_derived_rois(const SegmentCommand& command, const RoiDrawings& drawings, RoiResults& results, const Work& work) {
    const std::vector<std::string> rules = read_rules_file(command.rules);
    std::vector<DerivedStructure> derived =
        derive(rules, results.for_rules, {.image = drawings.image ? &*drawings.image : nullptr}, work);
    for (DerivedStructure& one : derived) {
        FittedRoi derived;
        derived.rule = one.rule;
        derived.roi.name = one.name;
        derived.roi.contours.attributes = derived_attributes(one);
        derived.roi.contours.attributes.color = structure_color(results.all.size());
        derived.segment = derived_segment(one.name, derived.roi.contours.attributes);
        const auto inside = std::count(one.mask.values.begin(), one.mask.values.end(), 1);
        derived.report.mask_voxels = inside;
        derived.report.mask_volume_ml = static_cast<double>(inside) * one.mask.grid.voxel_volume_mm3() / 1000;
        const Index3& size = one.mask.grid.size;
        results.add(command, std::move(derived), std::move(one.outlines), std::move(one.mask),
                    {{0, 0, 0}, {size.i - 1, size.j - 1, size.k - 1}});
    }
}

}  // namespace kontur::app
