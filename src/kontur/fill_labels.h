// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/image/image_report.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// How far an object that was painted on parallel slices goes on beyond the first and the last of them.
enum class FillEnds {
    closed,  ///< not at all
    half,    ///< half of the way to where the next slice would be, as far as the fit says so
    open,    ///< as far as the fit says
};
std::string_view name(FillEnds ends) noexcept;

struct FillOptions {
    FillEnds ends = FillEnds::closed;
    /// Take labels that touch each other also as one object, and give what that claims and none of them has to the nearest:
    /// else gaps stay between them. Between parallel slices its shapes tell that object, elsewhere a fit of it.
    bool jointly = true;
    /// Between parallel slices, how far the shape-based interpolation counts beside the fit, from 0 to 1: the share where
    /// the slices are close for the thickness of the object; less where they are not (see ShapeInterpolation::trust).
    double shape_weight = 0.5;
    UseImage use_image = UseImage::automatic;  ///< between the painted slices; where an image is given
    double smoothing_voxels = 0.7;             ///< of the painted outlines, see SectionContourOptions
    std::vector<std::int64_t> labels{};        ///< only these; empty: all
    std::optional<double> max_memory_mb{};     ///< as SegmentOptions'
};

/// What became of one label.
struct FilledLabel {
    std::int64_t label = 0;
    std::array<std::int64_t, 3> slices{};  ///< painted ones across the grid's axes i, j and k
    std::int64_t painted_voxels = 0;
    std::int64_t added_voxels = 0;
    ImageReport image{};                ///< what became of the image between the slices
    std::vector<std::string> warnings;  ///< one sentence each
};

struct FillReport {
    std::vector<FilledLabel> labels;                      ///< in increasing order
    std::int64_t contested_voxels = 0;                    ///< claimed by more than one label
    std::int64_t closed_voxels = 0;                       ///< between labels that touch, claimed by them together alone
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time by stage, in order
};

struct Filling {
    Image labels;
    FillReport report;
};

/// Fills what was left out of a label map: each label was painted on some slices, across any axis of the grid or several
/// (see find_painted_slices); between them its body is fitted to their outlines as `segment` does, and between parallel ones
/// averaged with the shape-based interpolation (see ShapeInterpolation). What was painted stays as it is, voxel for voxel,
/// and a slice that was painted as a whole gets nothing more. Where several labels claim a voxel, it goes to the one that it
/// lies deepest in, f / |grad f|. A label painted on one slice alone, and one of whose slices none was left out, stay as
/// they are. Throws Error(invalid_input) for an image that is no label map (see count_labels), one without labels, a label
/// to fill that is not in it, a smoothing below 0 and an image that lies apart; Error(too_large) as `segment` does. Works
/// within the labels' boxes. With `use_image` the image (on any grid of the same frame) tells, where it helps, how each
/// label's surface runs between the slices; the shape-based interpolation then counts less, by the square of how much
/// smaller the image makes the error at slices left out. The same bytes for any number of threads.
Filling fill_labels(Image labels, const FillOptions& options = {}, const Work& work = {});
Filling fill_labels(Image labels, const Image* image, const FillOptions& options = {}, const Work& work = {});

}  // namespace kontur
