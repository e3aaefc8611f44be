// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/mask_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/correct/change.h"
#include "kontur/correct/corrected_section.h"
#include "kontur/correct/correction_data.h"
#include "kontur/correct/mask_part.h"
#include "kontur/correct/reach_by_image.h"
#include "kontur/measure/components.h"

namespace kontur {
namespace {

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

/// Around some voxels of a grid.
template <class Voxel>
IndexBox box_with(IndexBox box, const std::vector<Voxel>& voxels, const Index3& size) {
    for (const Voxel& voxel : voxels) {
        const Index3 at = index_at(voxel.offset, size);
        box = box_around(box, {at, at});
    }
    return box;
}

/// Finds the pieces that hang loose, in the box of all that is or was inside.
class LooseSearch {
public:
    LooseSearch(const MaskToCorrect& what, const std::vector<MadeVoxel>& voxels)
        : whole_(what.mask.grid),
          box_(box_with(what.surface.object_box(), voxels, whole_.size)),
          before_(part_of(what.mask, box_)),
          after_(before_) {
        for (const MadeVoxel& voxel : voxels) after_.values[in_box(voxel.offset)] = voxel.is_inside();
        parts_ = find_components(after_);
        loose_ = loose_components(before_, parts_);
    }

    std::vector<LoosePiece> pieces() const {
        std::vector<LoosePiece> pieces;
        for (const std::size_t component : loose_) {
            const auto run = std::ranges::find(parts_.runs, component, &ComponentRun::component);
            const Index3 middle = index_at((run->begin + run->end) / 2, after_.grid.size);
            const auto voxels = parts_.sizes[component];
            pieces.push_back({voxels, static_cast<double>(voxels) * whole_.voxel_volume_mm3() / 1000,
                              after_.grid.center_mm(middle.i, middle.j, middle.k)});
        }
        return pieces;
    }

    /// Takes them away from what becomes of the mask.
    void drop_from(std::vector<MadeVoxel>& voxels) const {
        std::vector<MadeVoxel> dropped;
        for (const ComponentRun& run : parts_.runs) {
            if (std::ranges::find(loose_, run.component) == loose_.end()) continue;
            for (std::size_t n = run.begin; n < run.end; ++n)
                dropped.push_back({in_whole(n), CorrectedVoxel::removed_carried});
        }
        std::vector<MadeVoxel> kept;  // a voxel inside a piece was added, or stayed
        std::ranges::set_difference(voxels, dropped, std::back_inserter(kept), {}, &MadeVoxel::offset, &MadeVoxel::offset);
        std::erase_if(dropped, [&](const MadeVoxel& voxel) { return before_.values[in_box(voxel.offset)] == 0; });
        voxels.clear();
        std::ranges::merge(kept, dropped, std::back_inserter(voxels), {}, &MadeVoxel::offset, &MadeVoxel::offset);
    }

private:
    std::size_t in_box(std::size_t offset) const {
        const Index3 at = index_at(offset, whole_.size);
        return after_.grid.offset(at.i - box_.low.i, at.j - box_.low.j, at.k - box_.low.k);
    }
    std::size_t in_whole(std::size_t offset) const {
        const Index3 at = index_at(offset, after_.grid.size);
        return whole_.offset(at.i + box_.low.i, at.j + box_.low.j, at.k + box_.low.k);
    }

    const Grid& whole_;
    IndexBox box_;
    Mask before_, after_;
    Components parts_;
    std::vector<std::size_t> loose_;  ///< of these
};

void find_loose(const MaskToCorrect& what, bool drop, MaskChange& change) {
    if (std::ranges::all_of(change.voxels, &MadeVoxel::is_inside)) return;  // nothing was cut
    const LooseSearch search(what, change.voxels);
    change.report.loose_pieces = search.pieces();
    change.report.dropped_loose = drop && !change.report.loose_pieces.empty();
    if (change.report.dropped_loose) search.drop_from(change.voxels);
}

void count(const ExistingSurface& surface, MaskChange& change) {
    std::array<std::int64_t, 8> counts{};
    for (const MadeVoxel& voxel : change.voxels) ++counts[static_cast<std::size_t>(voxel.how)];
    CorrectReport& report = change.report;
    const auto of = [&](CorrectedVoxel voxel) { return counts[static_cast<std::size_t>(voxel)]; };
    report.added_drawn = of(CorrectedVoxel::added_drawn);
    report.removed_drawn = of(CorrectedVoxel::removed_drawn);
    report.added_carried = of(CorrectedVoxel::added_carried);
    report.removed_carried = of(CorrectedVoxel::removed_carried);
    report.added_image = of(CorrectedVoxel::added_image);
    report.removed_image = of(CorrectedVoxel::removed_image);
    const std::int64_t old = surface.voxels_inside();
    const std::int64_t kept = old - report.removed_drawn - report.removed_carried - report.removed_image;
    const std::int64_t now = kept + report.added_drawn + report.added_carried + report.added_image;
    const double ml = surface.grid().voxel_volume_mm3() / 1000;
    report.volume_before_ml = static_cast<double>(old) * ml;
    report.volume_ml = static_cast<double>(now) * ml;
    report.dice = old + now > 0 ? 2 * static_cast<double>(kept) / static_cast<double>(old + now) : 1;
}

}  // namespace

MaskChange mask_change(const MaskToCorrect& what, const Corrections& corrections, const CorrectOptions& options,
                       const Work& work) {
    check_options(options);
    const auto& [mask, surface, image] = what;
    if (image) check_image(*image);
    const CorrectionLengths lengths = correction_lengths(surface, options.reach);
    work.report("correct", 0);
    const std::vector<CorrectedSection> sections = corrected_sections(surface, corrections, lengths.step);
    const CorrectionData data = correction_data(surface, sections, corrections.drawing, lengths);
    MaskChange change;
    CorrectReport& report = change.report;
    report.warnings = data.contradictions;
    warn_of_parts(sections, surface, report.warnings);
    work.report("correct", 0.3);
    change.function = std::make_shared<const SurfaceChange>(solve_change(surface, data, lengths, work));
    work.report("correct", 0.6);
    change.lattice = change_lattice(surface, *change.function, work);
    std::vector<VoxelSide> carried, by_image;
    if (change.lattice) carried = carried_voxels(mask, surface, *change.function, *change.lattice, work);
    if (image) {
        work.report("correct", 0.7);
        ImageReachedVoxels reached =
            reach_by_image({mask, surface, corrections.drawing, sections, options.reach}, *image, work);
        report.image = reached.reach;
        by_image = std::move(reached.voxels);
    }
    const IndexBox box = box_with(box_with(surface.object_box(), carried, mask.grid.size), by_image, mask.grid.size);
    change.voxels = made_voxels(mask, carried, drawn_voxels(sections, mask.grid, box), by_image);
    find_loose(what, options.drop_loose, change);
    count(surface, change);
    report.length_mm = lengths.length;
    report.reach_mm = kReachLengths * lengths.length;
    for (const CorrectedSection& section : sections)
        report.planes.push_back({kind_of(section), section.plane, section.contours, section.largest_move_mm});
    work.report("correct", 1);
    return change;
}

}  // namespace kontur
