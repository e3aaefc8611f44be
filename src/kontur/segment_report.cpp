// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "kontur/base/machine_memory.h"

namespace kontur {
namespace {

using Facts = nlohmann::ordered_json;

Facts seconds_json(const SegmentReport& report) {
    Facts seconds = Facts::object();
    for (const auto& [stage, duration] : report.seconds) seconds[stage] = duration;
    seconds["total"] = total_seconds(report);
    return seconds;
}

Facts triple(const Vec3& v) { return {v.x, v.y, v.z}; }

/// How many there are, how well they agree, and the five worst; contours are counted from 1.
Facts crossings_json(const std::vector<Crossing>& crossings) {
    constexpr std::size_t kShown = 5;
    const Disagreement all = disagreement(crossings);
    Facts worst = Facts::array();
    for (const Crossing& c : std::span(crossings).first(std::min(kShown, crossings.size())))
        worst.push_back({{"contour", c.contour + 1},
                         {"other", c.other + 1},
                         {"matched", c.matched},
                         {"disagreement_mm", c.disagreement_mm},
                         {"distance_mm", c.distance_mm},
                         {"position_mm", triple(c.position)},
                         {"other_position_mm", triple(c.other_position)}});
    return {{"matched", all.matched},
            {"unmatched", all.unmatched},
            {"disagreement_mm", {{"max", all.max_mm}, {"rms", all.rms_mm}, {"mean", all.mean_mm}}},
            {"worst", worst}};
}

/// Contours are counted from 1, as they came.
Facts near_lines_json(const std::vector<NearLines>& pairs) {
    Facts facts = Facts::array();
    for (const NearLines& pair : pairs)
        facts.push_back({{"contour", pair.contour + 1},
                         {"other", pair.other + 1},
                         {"apart_mm", pair.apart_mm},
                         {"share", pair.share},
                         {"read_as", pair.is_one ? "one line" : "wall"}});
    return facts;
}

Facts region_json(const WrongRegion& region) {
    return {{"position_mm", triple(region.position)}, {"area_mm2", region.area_mm2}, {"depth_mm", region.depth_mm},
            {"missing", region.is_missing},           {"island", region.is_island},  {"lost", region.is_lost},
            {"explained", region.is_explained}};
}

/// Of an empty plane: null.
Facts contour_json(const std::optional<std::size_t>& contour) { return contour ? Facts(*contour + 1) : Facts(nullptr); }

/// Each drawn plane that is wrong, with its three largest regions, and what is wrong between and beyond the planes.
Facts section_check_json(const SectionCheck& check) {
    constexpr std::size_t kShown = 3;
    Facts planes = Facts::array(), between = Facts::array(), beyond = Facts::array();
    for (const PlaneCheck& plane : check.planes) {
        if (!plane.is_wrong) continue;
        Facts regions = Facts::array();
        for (const WrongRegion& region : std::span(plane.regions).first(std::min(kShown, plane.regions.size())))
            regions.push_back(region_json(region));
        planes.push_back({{"contour", contour_json(plane.contour)},
                          {"area_mm2", plane.area_mm2},
                          {"wrong_share", plane.wrong_share},
                          {"island_share", plane.island_share},
                          {"regions", std::move(regions)}});
    }
    for (const BetweenCheck& pair : check.between)
        if (pair.is_wrong)
            between.push_back({{"contour", pair.contour + 1},
                               {"other", pair.other + 1},
                               {"missing_share", pair.missing_share},
                               {"gap_mm", pair.gap_mm},
                               {"position_mm", triple(pair.position)}});
    for (const BeyondCheck& end : check.beyond)
        if (end.is_wrong)
            beyond.push_back({{"contour", end.contour + 1},
                              {"length_mm", end.length_mm},
                              {"gap_mm", end.gap_mm},
                              {"position_mm", triple(end.position)}});
    return {{"planes", check.planes.size()},     {"largest_wrong_share", check.largest_wrong_share()},
            {"wrong_planes", std::move(planes)}, {"between", std::move(between)},
            {"beyond", std::move(beyond)},       {"outside_share", check.outside_share},
            {"sentences", sentences(check)}};
}

Facts provenance_json(const Provenance& provenance) {
    Facts facts = Facts::object();
    for (const auto& [key, value] : provenance) facts[key] = value;
    return facts;
}

Facts mask_json(const SegmentReport& report) {
    return {{"voxels", report.mask_voxels}, {"volume_ml", report.mask_volume_ml}, {"components", report.mask_components}};
}

Facts image_json(const ImageReport& image) {
    Facts facts;
    visit_facts(image, [&](const char* key, const auto& value) { facts[key] = value; });
    return facts;
}

Facts uncertainty_json(const SurfaceUncertainty& u) {
    if (!u.is_known) return {{"planes", u.planes}, {"known", false}};
    return {{"planes", u.planes},
            {"known", true},
            {"expected_dice", {{"value", u.dice.value}, {"low", u.dice.low}, {"high", u.dice.high}}},
            {"planes_to_dice", {{"0.95", u.planes_to_95}, {"0.98", u.planes_to_98}}},
            {"half_width_mm", {{"median", u.half_width_median_mm}, {"p90", u.half_width_p90_mm}}},
            {"volume_ml", {{"value", u.volume_ml}, {"low", u.volume_low_ml}, {"high", u.volume_high_ml}}},
            {"farthest_from_contours_mm", u.farthest_mm},
            {"farthest_position_mm", triple(u.farthest_position)}};
}

Facts report_json(const SegmentReport& report, const Provenance& provenance) {
    return {
        {"version", KONTUR_VERSION},
        {"provenance", provenance_json(provenance)},
        {"contours", report.contours},
        {"points", report.points},
        {"constraints", report.constraints},
        {"centres", report.centres},
        {"merged", report.merged},
        {"bounded", report.bounded},
        {"kernel", name(report.kernel)},
        {"normals", name(report.normals)},
        {"normal_offset_mm", report.normal_offset_mm},
        {"smoothing", report.smoothing},
        {"tolerance_mm", report.tolerance_mm},
        {"conflicts", name(report.conflicts)},
        {"fill_rule", name(report.fill_rule)},
        {"corners", name(report.corners)},
        {"quality", report.quality},
        {"solver", name(report.solver)},
        {"solves", report.solves},
        {"iterations", report.iterations},
        {"residual_mm", {{"max", report.residual.max_mm}, {"rms", report.residual.rms_mm}}},
        {"crossings", crossings_json(report.crossings)},
        {"near_lines", near_lines_json(report.near_lines)},
        {"section_check", section_check_json(report.section_check)},
        {"voxelizer", name(report.voxelizer)},
        {"evaluations", report.evaluations},
        {"surface_voxels", report.surface_voxels},
        {"image", image_json(report.image)},
        {"seconds", seconds_json(report)},
        {"peak_memory_mb", peak_memory_mb()},
        {"estimated_memory_mb", report.estimated_memory_mb},
        {"mask", mask_json(report)},
        {"uncertainty", uncertainty_json(report.uncertainty)},
        {"warnings", report.warnings},
    };
}

}  // namespace

std::string to_json(const SegmentReport& report, const Provenance& provenance) {
    return report_json(report, provenance).dump(2, ' ', false, Facts::error_handler_t::replace) + "\n";
}

double total_seconds(const SegmentReport& report) {
    double total = 0;
    for (const auto& lap : report.seconds) total += lap.second;
    return total;
}

}  // namespace kontur
