// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kontur/segment.h"
#include "kontur/sureness/surface_evidence.h"
#include "truth.h"

namespace kontur {

/// What an annotator has drawn, what kontur makes of it, and how long the drawing took.
class Annotator {
public:
    Annotator(const Truth& truth, UseImage use_image) : truth_(truth), use_image_(use_image) {
        contours_.name = truth.name();
    }

    const Truth& truth() const { return truth_; }
    const ContourSet& contours() const { return contours_; }
    const std::vector<Plane>& planes() const { return planes_; }
    const std::optional<Segmentation>& segmentation() const { return segmentation_; }
    const SurfaceEvidence& evidence() const { return evidence_; }

    /// Draws what the plane shows, and fits if `and_fit`. `is_shown`: a suggestion, which the annotator has not to look for.
    void draw(const Plane& plane, bool is_shown, bool and_fit = true);
    void fit();

    /// Everything about the state that is measured, with every `sample_step`-th sample of the surface; 0: none.
    nlohmann::ordered_json facts(std::size_t sample_step) const;

private:
    void add_seconds(const std::vector<Contour>& drawn, bool is_shown);

    const Truth& truth_;
    UseImage use_image_;  ///< where the truth has one
    ContourSet contours_;
    std::vector<Plane> planes_;
    std::optional<Segmentation> segmentation_;
    SurfaceEvidence evidence_;  ///< of the segmentation
    double drawing_s_ = 0, accepting_s_ = 0;
};

}  // namespace kontur
