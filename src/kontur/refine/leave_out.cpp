// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/leave_out.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/refine/quantile.h"
#include "kontur/refine/spread_points.h"
#include "kontur/refine/surface_evidence.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

constexpr std::size_t kMostPlanes = 10, kLeastPoints = 10;
constexpr std::size_t kFewestPlanes = 4;  // two are too few to tell how a surface runs, when one of three is left out
constexpr std::size_t kSamples = 300;
constexpr double kHeldOutPoints = 500;  // of all planes together
constexpr double kDeviation = 1.4826;   // standard deviation over the median of absolute values of a normal distribution
constexpr double kMeanOfDeviation = 0.7979;  // the mean of absolute values over the standard deviation, likewise
constexpr double kMostSlope = 0.25;          // prior standard deviation over the distance
constexpr double kHelps = 0.95;              // of the mean error without the image
constexpr double kSure = 1;                  // standard errors of the mean gain over the planes
constexpr double kDoubt = 1.3;               // errors with the image count as that much larger
constexpr std::size_t kNear = 40;            // held-out points that speak for a place
constexpr double kLeastImage = 0.25;         // voxels: no image is better known than this
constexpr double kSurfaceSpacing = 0.04;     // of the drawing's diameter

/// What is left of an error that the hand's own, independent of it, is part of: at least half of it.
double without_hand(double error, double hand) {
    return std::sqrt(std::max(error * error - hand * hand, 0.25 * error * error));
}

/// The contours of each plane, in the order of the planes' first ones.
std::vector<std::vector<std::size_t>> contours_by_plane(const ContourSet& set) {
    const std::vector<std::size_t> plane = shared_planes(set.contours, kSamePlane * diameter_mm(set));
    std::vector<std::vector<std::size_t>> groups;
    std::vector<std::size_t> first;
    for (std::size_t c = 0; c < plane.size(); ++c) {
        const auto at = static_cast<std::size_t>(std::find(first.begin(), first.end(), plane[c]) - first.begin());
        if (at == first.size()) {
            first.push_back(plane[c]);
            groups.emplace_back();
        }
        groups[at].push_back(c);
    }
    return groups;
}

ContourSet with_contours(const ContourSet& set, const std::vector<std::size_t>& group, bool kept) {
    ContourSet part = set;
    part.contours.clear();
    for (std::size_t c = 0; c < set.contours.size(); ++c)
        if ((std::find(group.begin(), group.end(), c) != group.end()) == kept) part.contours.push_back(set.contours[c]);
    return part;
}

/// One plane left out: the surface through the others, and where it should have passed.
struct Fold {
    ImplicitFunction function;
    DrawnOnImage others;
    std::vector<Vec3> samples;
    std::vector<Vec3> held_out;           ///< drawn points
    std::vector<MovingPoint> on_surface;  ///< the points of the surface nearest to them
    std::vector<double> errors_mm;        ///< how far the surface has to move there
};

std::optional<Fold> leave_out(const ContourSet& drawn, const std::vector<std::size_t>& group, const Image& image,
                              const FitContours& fit, double step_mm, const Work& alone) {
    try {
        const Drawing rest(with_contours(drawn, group, false), FillRule::declared);
        Fold fold{fit(rest.contours), DrawnOnImage(rest, image), {}, {}, {}, {}};
        const double spacing = kSurfaceSpacing * rest.diameter_mm();
        fold.samples =
            spread(points_of_surface(fold.function, rest.contours, spacing, alone), kSamples, frame_of(rest.contours));
        if (fold.samples.size() < kLeastPoints) return std::nullopt;
        slide_to_surface(fold.function, fold.samples, {.reach_mm = spacing}, alone);
        fold.held_out = along_contours(with_contours(drawn, group, true), step_mm);
        std::vector<Vec3> nearest = fold.held_out;
        slide_to_surface(fold.function, nearest, {.reach_mm = 0.25 * rest.diameter_mm(), .steps = 3}, alone);
        fold.on_surface = with_normals(fold.function, nearest, alone);
        for (std::size_t i = 0; i < nearest.size(); ++i) {
            fold.on_surface[i].distance_mm = nearest_distance(nearest[i], fold.others.points);
            fold.errors_mm.push_back(dot(fold.held_out[i] - nearest[i], fold.on_surface[i].normal));
        }
        return fold;
    } catch (const Error& error) {
        // What is left of a drawing may be too little to be one.
        if (error.kind() == ErrorKind::cancelled) throw;
        return std::nullopt;
    }
}

/// What the folds say before the image is looked at. Errors grow with the distance from the contours to the power of 1.5.
struct PlainErrors {
    double factor = 0;    ///< standard deviation = factor distance^1.5
    double limit_mm = 0;  ///< errors larger than this say no more
};

std::optional<PlainErrors> plain_errors(const std::vector<std::optional<Fold>>& folds, double voxel_mm) {
    std::vector<double> ratios, errors;
    for (const auto& fold : folds) {
        if (!fold) continue;
        for (std::size_t i = 0; i < fold->errors_mm.size(); ++i) {
            const double error = std::abs(fold->errors_mm[i]), far = fold->on_surface[i].distance_mm;
            errors.push_back(error);
            if (far > voxel_mm) ratios.push_back(error / std::pow(far, 1.5));
        }
    }
    if (ratios.size() < kLeastPoints) return std::nullopt;
    return PlainErrors{kDeviation * median(std::move(ratios)), 1.5 * quantile(std::move(errors), 0.9) + voxel_mm};
}

struct FoldErrors {
    std::vector<HeldOut> points;
    std::int64_t intensities = 0;
};

FoldErrors errors_with_image(Fold& fold, std::size_t plane, const Beliefs& beliefs, double voxel_mm, const Work& alone) {
    const Movement movement = find_movement(fold.others, fold.function, fold.samples, beliefs, alone);
    FoldErrors errors{{}, movement.intensities};
    for (std::size_t i = 0; i < fold.held_out.size(); ++i) {
        MovingPoint& at = fold.on_surface[i];
        if (at.distance_mm <= voxel_mm) continue;
        at.prior_mm = beliefs.prior_mm(at.distance_mm);
        const double moved = offset_at(at, movement.points, movement.prior, movement.offsets);
        errors.points.push_back({fold.held_out[i], at.distance_mm, fold.errors_mm[i], fold.errors_mm[i] - moved, plane});
    }
    return errors;
}

/// At most `kMostPlanes`, evenly.
std::vector<std::vector<std::size_t>> chosen(const std::vector<std::vector<std::size_t>>& groups) {
    if (groups.size() <= kMostPlanes) return groups;
    std::vector<std::vector<std::size_t>> some;
    for (std::size_t n = 0; n < kMostPlanes; ++n) some.push_back(groups[n * (groups.size() - 1) / (kMostPlanes - 1)]);
    return some;
}

}  // namespace

HeldOutErrors::HeldOutErrors(std::vector<HeldOut> held_out, const Beliefs& beliefs, double limit_mm, double voxel_mm,
                             double hand_mm, std::size_t planes, std::int64_t intensities)
    : held_out_(std::move(held_out)),
      beliefs_(beliefs),
      voxel_mm_(voxel_mm),
      hand_mm_(hand_mm),
      planes_(planes),
      intensities_(intensities) {
    std::vector<double> without, with, distances;
    for (HeldOut& h : held_out_) {
        without.push_back(h.without_mm = std::min(std::abs(h.without_mm), limit_mm));
        with.push_back(h.with_mm = std::min(std::abs(h.with_mm), limit_mm));
        distances.push_back(h.distance_mm);
        without_mm_ += h.without_mm;
        with_mm_ += h.with_mm;
    }
    without_mm_ /= static_cast<double>(held_out_.size());
    with_mm_ /= static_cast<double>(held_out_.size());
    median_without_ = median(std::move(without));
    median_with_ = median(std::move(with));
    median_distance_ = median(std::move(distances));
}

bool HeldOutErrors::image_helps() const {
    const double hand = kMeanOfDeviation * hand_mm_;
    return without_hand(with_mm_, hand) <= kHelps * without_hand(without_mm_, hand) && helps_planes();
}

bool HeldOutErrors::helps_planes() const {
    struct Sum {
        double points = 0, gain_mm = 0;
        double mean() const { return gain_mm / points; }
    };
    std::map<std::size_t, Sum> planes;
    for (const HeldOut& h : held_out_) {
        planes[h.plane].points += 1;
        planes[h.plane].gain_mm += h.without_mm - h.with_mm;
    }
    const auto count = static_cast<double>(planes.size());
    double mean = 0, squares = 0;
    for (const auto& [plane, sum] : planes) mean += sum.mean() / count;
    for (const auto& [plane, sum] : planes) squares += std::pow(sum.mean() - mean, 2);
    return count < 2 || mean >= kSure * std::sqrt(squares / (count - 1) / count);
}

Beliefs HeldOutErrors::beliefs() const {
    return {beliefs_.prior_mm, [this](const MovingPoint& point) { return image_sd(point); }};
}

double HeldOutErrors::image_sd(const MovingPoint& point) const {
    std::vector<std::pair<double, std::size_t>> nearest(held_out_.size());
    for (std::size_t i = 0; i < held_out_.size(); ++i) nearest[i] = {distance(point.position, held_out_[i].position), i};
    const std::size_t count = std::min(kNear, nearest.size());
    std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end());
    std::vector<double> without, with;
    for (std::size_t n = 0; n < count; ++n) {
        without.push_back(held_out_[nearest[n].second].without_mm);
        with.push_back(held_out_[nearest[n].second].with_mm);
    }
    // What is left with the image is the posterior's error, not the image's: 1 / with^2 = 1 / without^2 + 1 / image^2.
    const double s0 = without_hand(kDeviation * 0.5 * (median(std::move(without)) + median_without_), hand_mm_);
    const double s1 = kDoubt * without_hand(kDeviation * 0.5 * (median(std::move(with)) + median_with_), hand_mm_);
    if (!(s0 > 0)) return std::max(s1, kLeastImage * voxel_mm_);
    const double known = std::max(1 / (s1 * s1) - 1 / (s0 * s0), 1e-3 / (s0 * s0));
    // Held-out contours are about twice as far from others as what lies between all of them. Of what lies farther than they
    // did, less is known.
    const double nearer = std::max(point.distance_mm / median_distance_, 0.1);
    return std::max(nearer / std::sqrt(known), kLeastImage * voxel_mm_);
}

std::optional<HeldOutErrors> leave_planes_out(const Drawing& drawing, const Image& image, const FitContours& fit,
                                              const Work& work) {
    const ContourSet& drawn = drawing.contours;
    const std::vector<std::vector<std::size_t>> planes = contours_by_plane(drawn);
    if (planes.size() < kFewestPlanes) return std::nullopt;
    const std::vector<std::vector<std::size_t>> groups = chosen(planes);
    const double voxel = Intensities(image).voxel_mm();
    const double step = std::max(voxel, length_mm(drawn) / kHeldOutPoints);
    std::vector<std::optional<Fold>> folds(groups.size());
    const Work alone{.threads = 1, .stop = work.stop};  // folds are computed beside each other
    parallel_for(static_cast<std::int64_t>(groups.size()), 1, work.threads, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            work.check();
            folds[i] = leave_out(drawn, groups[i], image, fit, step, alone);
        }
    });
    const std::optional<PlainErrors> plain = plain_errors(folds, voxel);
    if (!plain) return std::nullopt;
    const Beliefs beliefs{[plain = *plain](double d) {
        return std::min({plain.factor * std::pow(d, 1.5), kMostSlope * d, plain.limit_mm});
    }};
    std::vector<FoldErrors> errors(folds.size());
    parallel_for(static_cast<std::int64_t>(folds.size()), 1, work.threads, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            work.check();
            if (folds[i]) errors[i] = errors_with_image(*folds[i], i, beliefs, voxel, alone);
        }
    });
    std::vector<HeldOut> all;
    std::size_t held_out = 0;
    std::int64_t intensities = 0;
    for (const FoldErrors& part : errors) {
        all.insert(all.end(), part.points.begin(), part.points.end());
        held_out += !part.points.empty();
        intensities += part.intensities;
    }
    if (all.size() < kLeastPoints || held_out < 2) return std::nullopt;
    const double hand = trusted_disagreement_mm(disagreement(drawing.crossings)) / std::numbers::sqrt2;
    return HeldOutErrors(std::move(all), beliefs, plain->limit_mm, voxel, hand, held_out, intensities);
}

}  // namespace kontur
