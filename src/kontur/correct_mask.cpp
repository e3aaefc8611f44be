// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/correct/change.h"
#include "kontur/correct/corrected_section.h"
#include "kontur/correct/corrected_voxels.h"
#include "kontur/correct/correction_data.h"
#include "kontur/correct/reach_by_image.h"
#include "kontur/measure/components.h"

namespace kontur {
namespace {

constexpr double kLeastReach = 0.25, kMostReach = 4;

void check_options(const CorrectOptions& options) {
    if (!(options.reach >= kLeastReach && options.reach <= kMostReach))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the reach is {}, not between {} and {}", options.reach, kLeastReach, kMostReach));
}

CorrectionKind kind_of(const CorrectedSection& section) {
    if (!section.redrawn) return CorrectionKind::piece;
    if (section.contours.empty()) return section.after.outlines.empty() ? CorrectionKind::empty : CorrectionKind::confirmed;
    return CorrectionKind::outline;
}

/// Parts of the mask that a whole outline leaves out, and parts far from the mask that one adds.
void warn_of_parts(const std::vector<CorrectedSection>& sections, const ExistingSurface& surface,
                   std::vector<std::string>& warnings) {
    const double reach = kReachLengths * correction_length_mm(surface);
    for (const CorrectedSection& section : sections) {
        if (section.contours.empty()) continue;
        const std::size_t number = section.contours.front() + 1;
        for (std::size_t o = 0; o < section.before.outlines.size(); ++o) {
            const Polygon2& outline = section.before.outlines[o];
            const auto is_drawn = [&](const Point2& p) { return section.after.contains(p); };
            if (section.before.holes[o] || std::any_of(outline.begin(), outline.end(), is_drawn)) continue;
            const auto is_within = [&](const Polygon2& drawn) { return is_inside(outline, drawn.front()); };
            if (std::any_of(section.after.outlines.begin(), section.after.outlines.end(), is_within)) continue;
            warnings.push_back(
                fmt::format("contour {} leaves out a part of {:.0f} mm2 that the mask shows in its plane, and "
                            "so takes it away; draw that part, too, to keep it",
                            number, area(outline)));
        }
        for (std::size_t o = 0; o < section.after.outlines.size(); ++o) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const Point2& p : section.after.outlines[o])
                nearest = std::min(nearest, -surface.value(section.plane.from_uv(p)));
            if (nearest > reach)
                warnings.push_back(
                    fmt::format("contour {} lies {:.0f} mm from the mask, beyond the reach of {:.0f} mm: it "
                                "adds a thin part; kontur segment makes whole parts of contours",
                                section.contours[std::min(o, section.contours.size() - 1)] + 1, nearest, reach));
        }
    }
}

/// The components of the corrected mask that were one with a larger one before.
std::vector<std::size_t> loose_components(const Mask& before, const Components& after) {
    const Components old = find_components(before);
    std::vector<std::map<std::size_t, std::size_t>> shared(after.sizes.size());
    auto run = old.runs.begin();
    for (const ComponentRun& now : after.runs) {
        while (run != old.runs.end() && run->end <= now.begin) ++run;
        for (auto r = run; r != old.runs.end() && r->begin < now.end; ++r)
            shared[now.component][r->component] += std::min(r->end, now.end) - std::max(r->begin, now.begin);
    }
    std::vector<bool> is_there(old.sizes.size());
    std::vector<std::size_t> loose;
    for (std::size_t c = 0; c < shared.size(); ++c) {  // largest first
        if (shared[c].empty()) continue;
        bool hung = false;
        for (const auto& [component, voxels] : shared[c]) {
            hung = hung || is_there[component];
            is_there[component] = true;
        }
        if (hung) loose.push_back(c);
    }
    return loose;
}

/// How many voxels of each origin there are; eight alike, as nearly all are, count at once.
std::array<std::int64_t, 8> counts_of(const std::vector<std::uint8_t>& origins) {
    constexpr std::uint64_t kEight = 0x0101010101010101;
    std::array<std::int64_t, 8> counts{};
    std::size_t n = 0;
    for (std::uint64_t eight = 0; n + 8 <= origins.size(); n += 8) {
        std::memcpy(&eight, &origins[n], 8);
        if (eight == kEight * origins[n]) counts[origins[n]] += 8;
        else
            for (std::size_t m = n; m < n + 8; ++m) ++counts[origins[m]];
    }
    for (; n < origins.size(); ++n) ++counts[origins[n]];
    return counts;
}

void find_loose(const Mask& before, CorrectedMask& corrected, bool drop) {
    const std::array<std::int64_t, 8> counts = counts_of(corrected.origin);
    const auto of = [&](CorrectedVoxel voxel) { return counts[static_cast<std::size_t>(voxel)]; };
    if (of(CorrectedVoxel::removed_drawn) + of(CorrectedVoxel::removed_carried) + of(CorrectedVoxel::removed_image) == 0)
        return;  // nothing was cut
    const Components after = find_components(corrected.mask);
    const Grid& grid = corrected.mask.grid;
    std::map<std::size_t, std::size_t> pieces;  // of a component
    for (const std::size_t component : loose_components(before, after)) {
        pieces.emplace(component, corrected.report.loose_pieces.size());
        const auto voxels = after.sizes[component];
        corrected.report.loose_pieces.push_back({voxels, static_cast<double>(voxels) * grid.voxel_volume_mm3() / 1000, {}});
    }
    std::vector<bool> has_place(pieces.size());
    for (const ComponentRun& run : after.runs) {
        const auto piece = pieces.find(run.component);
        if (piece == pieces.end()) continue;
        if (!has_place[piece->second]) {
            const Index3 middle = index_at((run.begin + run.end) / 2, grid.size);
            corrected.report.loose_pieces[piece->second].position = grid.center_mm(middle.i, middle.j, middle.k);
            has_place[piece->second] = true;
        }
        for (std::size_t n = run.begin; drop && n < run.end; ++n) {
            corrected.mask.values[n] = 0;
            corrected.origin[n] =
                static_cast<std::uint8_t>(before.values[n] ? CorrectedVoxel::removed_carried : CorrectedVoxel::outside);
        }
    }
    corrected.report.dropped_loose = drop && !pieces.empty();
}

void count(const Mask& before, CorrectedMask& corrected) {
    const std::array<std::int64_t, 8> counts = counts_of(corrected.origin);
    CorrectReport& report = corrected.report;
    const auto of = [&](CorrectedVoxel voxel) { return counts[static_cast<std::size_t>(voxel)]; };
    report.added_drawn = of(CorrectedVoxel::added_drawn);
    report.removed_drawn = of(CorrectedVoxel::removed_drawn);
    report.added_carried = of(CorrectedVoxel::added_carried);
    report.removed_carried = of(CorrectedVoxel::removed_carried);
    report.added_image = of(CorrectedVoxel::added_image);
    report.removed_image = of(CorrectedVoxel::removed_image);
    const std::int64_t kept = of(CorrectedVoxel::inside);
    const std::int64_t old = kept + report.removed_drawn + report.removed_carried + report.removed_image,
                       now = kept + report.added_drawn + report.added_carried + report.added_image;
    const double ml = before.grid.voxel_volume_mm3() / 1000;
    report.volume_before_ml = static_cast<double>(old) * ml;
    report.volume_ml = static_cast<double>(now) * ml;
    report.dice = old + now > 0 ? 2 * static_cast<double>(kept) / static_cast<double>(old + now) : 1;
}

}  // namespace

std::string_view name(CorrectionKind kind) noexcept {
    switch (kind) {
        case CorrectionKind::outline:
            return "outline";
        case CorrectionKind::piece:
            return "piece";
        case CorrectionKind::empty:
            return "empty";
        case CorrectionKind::confirmed:
            break;
    }
    return "confirmed";
}

CorrectedMask correct(const Mask& mask, const Corrections& corrections, const CorrectOptions& options, const Work& work) {
    check_options(options);
    return correct(mask, ExistingSurface(mask, work), corrections, options, work);
}

CorrectedMask correct(const Mask& mask, const ExistingSurface& surface, const Corrections& corrections,
                      const CorrectOptions& options, const Work& work) {
    return correct(MaskToCorrect{mask, surface}, corrections, options, work);
}

CorrectedMask correct(const MaskToCorrect& what, const Corrections& corrections, const CorrectOptions& options,
                      const Work& work) {
    check_options(options);
    const auto& [mask, surface, image] = what;
    if (image) check_image(*image);
    const CorrectionLengths lengths = correction_lengths(surface, options.reach);
    work.report("correct", 0);
    const std::vector<CorrectedSection> sections = corrected_sections(surface, corrections, lengths.step);
    const CorrectionData data = correction_data(surface, sections, corrections.drawing, lengths);
    CorrectedMask corrected;
    CorrectReport& report = corrected.report;
    report.warnings = data.contradictions;
    warn_of_parts(sections, surface, report.warnings);
    work.report("correct", 0.3);
    SurfaceChange change = solve_change(surface, data, lengths, work);
    work.report("correct", 0.6);
    corrected.mask = changed_voxels(mask, surface, change, work);
    const std::vector<VoxelSide> drawn = drawn_voxels(sections, mask.grid);
    for (const VoxelSide& voxel : drawn) corrected.mask.values[voxel.offset] = voxel.inside;
    std::vector<VoxelSide> by_image;
    if (image) {
        work.report("correct", 0.7);
        ImageReachedVoxels reached =
            reach_by_image({mask, surface, corrections.drawing, sections, options.reach}, *image, work);
        report.image = reached.reach;
        by_image = std::move(reached.voxels);
        for (const VoxelSide& voxel : by_image) corrected.mask.values[voxel.offset] = voxel.inside;
    }
    corrected.origin = voxel_origins(mask, corrected.mask, drawn, by_image);
    find_loose(mask, corrected, options.drop_loose);
    count(mask, corrected);
    corrected.change = std::make_shared<const SurfaceChange>(std::move(change));
    report.length_mm = lengths.length;
    report.reach_mm = kReachLengths * lengths.length;
    for (const CorrectedSection& section : sections)
        report.planes.push_back({kind_of(section), section.plane, section.contours, section.largest_move_mm});
    work.report("correct", 1);
    return corrected;
}

std::string sentence(const CorrectReport& report) {
    const std::int64_t drawn = report.added_drawn + report.removed_drawn,
                       carried = report.added_carried + report.removed_carried + report.added_image + report.removed_image;
    if (drawn + carried == 0) return "nothing changed: the corrections repeat the mask";
    const double more = report.volume_ml - report.volume_before_ml;
    return fmt::format("{} changed, {} of them beside the drawn planes; {:.1f} ml {}, {:.1f} ml in all",
                       counted(static_cast<std::size_t>(drawn + carried), "voxel"), carried, std::abs(more),
                       more < 0 ? "less" : "more", report.volume_ml);
}

}  // namespace kontur
