// SPDX-License-Identifier: Apache-2.0
#include "annotator.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/evidence.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "true_border.h"

namespace kontur {
namespace {

// A model of time, not a measurement: a hand that draws a line as long as the object's diameter in 5 s, whatever the
// magnification; finding a plane in the image, or looking at one that is shown; starting a stroke.
constexpr double kSecondsPerDiameter = 5, kFindPlane_s = 4, kLookAtPlane_s = 2, kStroke_s = 1;
constexpr double kAcceptable = 0.01;  // of the diameter: a predicted outline no farther off is left as it is

}  // namespace

void Annotator::add_seconds(const std::vector<Contour>& drawn, bool is_shown) {
    const double looking = is_shown ? kLookAtPlane_s : kFindPlane_s;
    drawing_s_ += looking;
    accepting_s_ += looking;
    for (const Contour& contour : drawn) {
        double length = 0, wrong = 0;
        for (std::size_t n = 0; n < contour.points.size(); ++n) {
            const Vec3& p = contour.points[n];
            const double step = distance(p, contour.points[(n + 1) % contour.points.size()]) / truth_.diameter_mm();
            length += step;
            double off = 1;
            if (segmentation_) {
                const Vec3 gradient = segmentation_->function.gradient(p);
                off = std::abs(segmentation_->function.value(p)) / std::max(norm(gradient), 0.1) / truth_.diameter_mm();
            }
            if (off > kAcceptable) wrong += step;
        }
        drawing_s_ += kStroke_s + length * kSecondsPerDiameter;
        accepting_s_ += kStroke_s + wrong * kSecondsPerDiameter;  // a stroke at least, or the key that accepts
    }
}

void Annotator::draw(const Plane& plane, bool is_shown, bool and_fit) {
    const std::vector<Contour> drawn = truth_.draw(plane);
    add_seconds(drawn, is_shown);
    planes_.push_back(plane);
    contours_.contours.insert(contours_.contours.end(), drawn.begin(), drawn.end());
    if (and_fit) fit();
}

void Annotator::fit() {
    segmentation_.reset();
    try {
        const Image* image = truth_.image() ? &*truth_.image() : nullptr;
        segmentation_ = segment(contours_, truth_.grid(), image, {.use_image = use_image_, .mesh = true}, {.threads = 1});
        evidence_ = gather_evidence(*segmentation_, contours_, {.threads = 1});
    } catch (const Error&) {  // counts as nothing drawn
    }
}

nlohmann::ordered_json Annotator::facts(std::size_t sample_step) const {
    nlohmann::ordered_json facts{
        {"planes", planes_.size()}, {"drawing_s", rounded(drawing_s_, 0.1)}, {"accepting_s", rounded(accepting_s_, 0.1)}};
    if (!segmentation_) {
        facts["dice"] = 0;
        return facts;
    }
    const SurfaceEvidence& e = evidence_;
    facts["dice"] = rounded(truth_.dice(segmentation_->mask), 1e-5);
    facts["verdict"] = name(segmentation_->report.image.verdict);
    facts["different_planes"] = e.plane_count();
    facts["whole_planes"] = e.whole_planes();
    facts["size_mm"] = e.size_mm;
    facts["area_mm2"] = e.samples.area_mm2();
    facts["volume_mm3"] = e.volume_mm3;
    facts["true_volume_mm3"] = truth_.volume_mm3();
    facts["voxel_mm"] = truth_.drawing_voxel_mm();
    facts["residual_mm"] = e.residual_mm;
    facts["disagreement_mm"] = e.disagreement_mm;
    facts["hand_mm"] = e.hand_mm;
    facts["expected_dice"] = expected_dice(e).value;
    if (sample_step == 0) return facts;
    nlohmann::ordered_json samples = nlohmann::ordered_json::array();
    double area = 0;
    for (std::size_t n = 0; n < e.samples.points.size(); ++n) {
        area += e.samples.areas_mm2[n];
        if (n % sample_step != sample_step / 2) continue;
        samples.push_back({rounded(e.distances_mm[n] / e.size_mm, 1e-5), rounded(e.samples.slopes[n], 1e-3),
                           rounded(truth_.distance_at(e.samples.points[n]) / e.size_mm, 1e-5),
                           rounded(e.samples.areas_mm2[n] / e.samples.area_mm2(), 1e-6)});
    }
    facts["samples"] = std::move(samples);
    facts["border"] = border_rows(e, *segmentation_->mesh, truth_.border());
    return facts;
}

}  // namespace kontur
