// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/moving/mask_course.h"
#include "kontur/moving/moving_function.h"
#include "kontur/segment.h"
#include "kontur/volume_curve.h"

namespace kontur {

class MeshCourse;

/// The function of space and time that contours of several moments make.
struct MovingFit {
    MovingFunction function;
    std::vector<DrawnMoment> moments;
    std::vector<std::string> warnings;
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time by stage, in order

    /// Masks at all times, on the grid of the fit.
    MaskCourse mask_course(const Work& work = {}) const;
    /// Surfaces at all times, as fine as files have them.
    MeshCourse mesh_course(const Work& work = {}) const;
    /// Points of each moment's contours, mm: where a MeshCourse starts.
    std::vector<std::vector<Vec3>> starts() const;
};

/// The image that an object moves in.
struct FramesToSegment {
    /// The voxels at a time; null at a time between its frames.
    using ImageAt = std::function<std::shared_ptr<const Image>(double)>;

    FramesToSegment(Grid its_grid, ImageAt its_images = {}) : grid(std::move(its_grid)), image_at(std::move(its_images)) {}

    Grid grid;
    ImageAt image_at;  ///< may be empty: the voxels are not looked at
};

/// Fits objects that move, on one grid. A moment whose contours are those of the fit before is not fitted again.
class MovingFitter {
public:
    explicit MovingFitter(FramesToSegment frames, SegmentOptions options = {})
        : frames_(std::move(frames)), options_(std::move(options)) {}

    /// Throws as segment_moving does; then what was fitted before is kept.
    MovingFit fit(const ContourSet& contours, std::span<const double> times, const Work& work = {});

private:
    /// `follows_image`: as far as that helps.
    DrawnMoment fitted(ContourSet set, double time, bool follows_image, const Work& work) const;

    FramesToSegment frames_;
    SegmentOptions options_;
    std::vector<DrawnMoment> known_;  ///< of the fit before
};

/// Masks of a moving object, and the function of space and time that they were made from.
struct MovingSegmentation {
    std::vector<double> times;
    std::vector<Mask> masks;           ///< at each of the times
    std::vector<TriangleMesh> meshes;  ///< at each of the times, with SegmentOptions::mesh
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
/// single moment, or of none, give `segment`'s mask at all times. Where a whole moment is one of the image's frames, its
/// function follows that, as `segment`'s does.
/// Contours in any order and times in any unit give the same masks; the same bytes for any number of threads. Throws as
/// `segment` and moments_of do, and Error(invalid_input) without times, or for a contour before or after all of them.
MovingSegmentation segment_moving(const ContourSet& contours, const FramesToSegment& frames, std::span<const double> times,
                                  const SegmentOptions& options = {}, const Work& work = {});

}  // namespace kontur
