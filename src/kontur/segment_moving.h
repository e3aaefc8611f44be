// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/moving/mask_course.h"
#include "kontur/moving/moving_function.h"
#include "kontur/segment.h"

namespace kontur {

/// A moment at which something was drawn.
struct DrawnMoment {
    double time = 0;           ///< frame, from 1, or seconds
    std::size_t contours = 0;  ///< drawn at it
    std::size_t carried = 0;   ///< sections in planes that were drawn at other moments alone
    ContourSet set{};          ///< what it was fitted to: what was drawn, and then these sections
    Segmentation segmentation;
};

/// A volume over time.
struct VolumeCurve {
    std::vector<double> volumes_ml;  ///< of the masks
    std::size_t largest = 0, smallest = 0;
    double stroke_ml() const { return volumes_ml[largest] - volumes_ml[smallest]; }
    /// Of the largest volume, from 0 to 1; of a heart's ventricle. 0 where all masks are empty.
    double ejection_fraction() const { return volumes_ml[largest] > 0 ? stroke_ml() / volumes_ml[largest] : 0; }
};

/// The function of space and time that contours of several moments make.
struct MovingFit {
    MovingFunction function;
    std::vector<DrawnMoment> moments;
    std::vector<std::string> warnings;
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time by stage, in order

    /// Masks at all times, on the grid of the fit.
    MaskCourse mask_course(const Work& work = {}) const;
    /// Points of each moment's contours, mm: where a MeshCourse starts.
    std::vector<std::vector<Vec3>> starts() const;
};

/// Fits objects that move, on one grid. A moment whose contours are those of the fit before is not fitted again.
class MovingFitter {
public:
    explicit MovingFitter(Grid grid, SegmentOptions options = {}) : grid_(std::move(grid)), options_(std::move(options)) {}

    /// Throws as segment_moving does; then what was fitted before is kept.
    MovingFit fit(const ContourSet& contours, std::span<const double> times, const Work& work = {});

private:
    DrawnMoment fitted(ContourSet set, const Work& work) const;

    Grid grid_;
    SegmentOptions options_;
    std::vector<DrawnMoment> known_;  ///< of the fit before
};

/// The volumes, and which of them are the extremes.
VolumeCurve volume_curve(std::vector<double> volumes_ml);

/// A table of the volumes as CSV: frame (from 1), time_s, volume_ml, contours drawn there, phase. `step_s` is from one time
/// to the next.
std::string volumes_csv(const std::vector<double>& times, const VolumeCurve& curve, const std::vector<DrawnMoment>& moments,
                        const std::optional<double>& step_s);

/// Masks of a moving object, and the function of space and time that they were made from.
struct MovingSegmentation {
    std::vector<double> times;
    std::vector<Mask> masks;  ///< at each of the times
    MovingFunction function;
    std::vector<DrawnMoment> moments;
    VolumeCurve volumes;
    std::vector<std::string> warnings;
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time by stage, in order
};

/// Contours drawn at some moments to masks at all `times`, in the contours' unit: frames, from 1, or seconds. Each moment at
/// which something was drawn is segmented by itself, as `segment` does; where little was drawn at it, sections of a process
/// in space and time stand for contours in planes that were drawn at other moments (carried_sections). Between moments
/// values of f run as TimeCourse says. The motion repeats where the contours say so (cycle_frames, cycle_s). Contours of a
/// single moment, or of none, give `segment`'s mask at all times. The image's voxels are not looked at, and no mesh is made.
/// Contours in any order and times in any unit give the same masks; the same bytes for any number of threads. Throws as
/// `segment` and moments_of do, and Error(invalid_input) without times, or for a contour before or after all of them.
MovingSegmentation segment_moving(const ContourSet& contours, const Grid& grid, std::span<const double> times,
                                  const SegmentOptions& options = {}, const Work& work = {});

}  // namespace kontur
