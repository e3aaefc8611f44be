// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/fitted_motion.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "kontur/base/error.h"

namespace kontur::viewer {
FittedMotion::FittedMotion(const State& state, Id structure, const FramesToSegment& frames, int times, const Work& work)
    : structure_(structure_of(state, structure)),
      set_(contour_set(state, structure)),
      frames_(static_cast<std::size_t>(times)) {
    std::iota(frames_.begin(), frames_.end(), 1);
    try {
        MovingFit fit =
            MovingFitter(frames, {.smoothing = structure_.smoothing, .drawn_on = frames.grid}).fit(set_, frames_, work);
        masks_.emplace(fit.mask_course(work));
        meshes_.emplace(fit.mesh_course(work));
        moments_ = std::move(fit.moments);
    } catch (const Error& error) {
        throw Error(error.kind(), fmt::format("{}: {}", structure_.name, error.what()));
    }
}

FittedStructure FittedMotion::at(int time) const {
    FittedStructure one{structure_, set_, {}, true, {}};
    const double frame = frames_.at(static_cast<std::size_t>(time));
    one.segmentation.mask = masks_->at(frame);
    one.segmentation.mesh = meshes_->at(frame);
    one.segmentation.report = moments_.front().segmentation.report;
    one.segmentation.report.mask_volume_ml = volume_ml(one.segmentation.mask);
    one.segmentation.report.uncertainty = {};  // that of one moment tells nothing of others
    return one;
}

std::vector<Mask> FittedMotion::masks() const {
    std::vector<Mask> masks;
    for (const double frame : frames_) masks.push_back(masks_->at(frame));
    return masks;
}

std::string FittedMotion::volumes_csv(const std::optional<double>& step_s) const {
    std::vector<double> volumes;
    for (const double frame : frames_) volumes.push_back(volume_ml(masks_->at(frame)));
    std::vector<VolumeInterval> intervals = volume_intervals(*masks_, sureness_of(moments_), frames_, volumes);
    return kontur::volumes_csv(frames_, volume_curve(std::move(volumes), std::move(intervals)), moments_, step_s);
}

std::size_t FittedMotion::bytes() const { return 2 * moments_.size() * moments_.front().segmentation.mask.values.size(); }

Provenance FittedMotion::provenance() const {
    const SegmentReport& report = moments_.front().segmentation.report;
    return kontur::provenance(set_, moments_.front().segmentation.mask.grid, report);
}

}  // namespace kontur::viewer
