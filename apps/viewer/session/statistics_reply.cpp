// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/statistics.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "viewer/files/structure_exports.h"
#include "viewer/model/model_json.h"
#include "viewer/model/status_line.h"
#include "viewer/session/replies.h"

// What is measured of all structures, in both images where there are two.

namespace kontur::viewer {
namespace {

using nlohmann::json;

json values_json(const ValueStatistics& found) {
    return {{"voxels", found.voxels},
            {"mean", found.mean},
            {"deviation", found.deviation},
            {"range", {found.least, found.most}}};
}

json row_json(const FittedStructure& one, const Image& image) {
    const Statistics found = statistics(*one.segmentation.mesh);
    json row = values_json(value_statistics(one.segmentation.mask, image));
    row.update({{"structure", one.structure.id},
                {"name", one.structure.name},
                {"contours", one.is_derived ? 0 : one.set.contours.size()},
                {"volume_ml", found.volume_ml},
                {"surface_cm2", found.surface_cm2},
                {"diameter_mm", found.diameter_mm},
                {"diameter", {to_json(found.from), to_json(found.to)}},
                {"extent_mm", to_json(found.extent_mm)}});
    if (const SurfaceUncertainty& sure = one.segmentation.report.uncertainty; sure.is_known)
        row["volume_90_ml"] = {sure.volume_low_ml, sure.volume_high_ml};
    return row;
}

/// The second image's own voxels within what moves are not looked at.
State still_alone(const State& now) {
    State still = now;
    std::erase_if(still.contours, [&](const auto& item) { return is_moving(now, item.second->structure); });
    return still;
}

/// In which it was drawn, or is looked at where it moves.
std::shared_ptr<const Image> image_of(SessionState& s, const State& now, Id structure, std::optional<int> time) {
    if (is_moving(now, structure)) return s.image.times.image(time.value_or(s.image.times.own()));
    const std::set<int> drawn = drawn_times(now, structure);
    const bool is_mask = structure_of(now, structure).mask.has_value();
    return s.image.times.image(drawn.empty() || is_mask ? s.image.times.own() : *drawn.begin());
}

}  // namespace

std::string statistics_reply(SessionState& s, std::optional<int> time, const StopToken& stop) {
    const StatusLine line(s.pages.status_teller(), "Measuring");
    const State now = s.state();
    const std::shared_ptr<const FurtherImage> second = s.second.get();
    const ExportFits::Fits fits = s.fits.all(now, line.work(stop), {time});
    const std::vector<FittedStructure>& all = *fits;
    json rows = json::array();
    for (const FittedStructure& one : all) rows.push_back(row_json(one, *image_of(s, now, one.structure.id, time)));
    json reply{{"unit", s.image.unit}};
    if (second) {
        const Image& other = *second->opened.image;
        const bool is_same_grid = other.grid == s.image.voxels->grid;
        const auto refitted = is_same_grid
                                  ? std::vector<FittedStructure>{}
                                  : fit_structures_on(other.grid, still_alone(now), *s.image.voxels, line.work(stop));
        const std::vector<FittedStructure>& on_other = is_same_grid ? all : refitted;
        for (json& row : rows) row["second"] = {{"voxels", 0}};
        for (std::size_t n = 0, row = 0; n < on_other.size(); ++n, ++row) {
            while (all[row].structure.id != on_other[n].structure.id) ++row;  // it lies beyond the second image
            rows[row]["second"] = values_json(value_statistics(on_other[n].segmentation.mask, other));
            rows[row]["second"]["points_beyond"] = points_outside(on_other[n].set, other.grid);
        }
        reply["second"] = {{"modality", second->opened.identity.modality}, {"unit", second->unit}};
    }
    reply["structures"] = std::move(rows);
    return to_text(reply);
}

}  // namespace kontur::viewer
