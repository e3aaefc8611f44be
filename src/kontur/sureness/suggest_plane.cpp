// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/suggest_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/sureness/candidate_planes.h"
#include "kontur/sureness/far_places.h"
#include "kontur/sureness/surface_evidence.h"
#include "kontur/sureness/uncertainty_model.h"

namespace kontur {
namespace {

// In diameters of the surface.
constexpr double kSlab = 0.02;      // samples so near to a plane stand for the line in which it cuts the surface
constexpr double kNearCopy = 0.03;  // nearer than that to a drawn plane, all along the cut, nothing new would be seen
constexpr double kMostOfCut = 0.8;
constexpr double kAlikeCosine = 0.94;     // 20 degrees
constexpr double kParallelCosine = 0.94;  // drawn planes that tell nothing of the direction across them
constexpr std::size_t kLeastInCut = 12;   // samples, 1 %; fewer are a tip that a contour could hardly be drawn around

// After two planes: as many through clusters of far places, which were worth more than the greedy choice
// (docs/accuracy/sureness.md).
constexpr std::size_t kFirstByClusters = 2, kByClusters = 2;
constexpr double kClusterReach = 0.06;  // of the diameter: from one place of a cluster to the next

// The best candidate is shifted and tilted by steps that halve from round to round. Candidates are apart by twice the first
// ones, which is more than the gaps are once eight planes are drawn.
constexpr double kFirstShift = 0.04;  // of the diameter
constexpr double kFirstTilt = 0.16;   // radians
constexpr int kRounds = 5, kStepsPerRound = 3;

/// A candidate and the surface in it.
struct Cut {
    Plane plane;
    std::optional<ImageSlice> slice{};
    std::vector<Vec3> line;  ///< points of the surface on the plane, in no order
    double gain = 0;
};

Vec3 middle_of(const std::vector<Vec3>& line) {
    return std::accumulate(line.begin(), line.end(), Vec3{}) / static_cast<double>(line.size());
}

class Chooser {
public:
    Chooser(const SurfaceEvidence& evidence, const std::vector<Plane>& empty, const SuggestPlaneOptions& options,
            const Work& work)
        : evidence_(evidence),
          options_(options),
          work_(work),
          avoided_(evidence.lines.planes()),
          distances_(evidence.distances_mm) {
        for (const std::vector<Plane>* some : {&empty, &options.avoid})
            avoided_.insert(avoided_.end(), some->begin(), some->end());
        for (std::size_t n = 0; n < distances_.size(); ++n) {
            const double slope = std::clamp(evidence.samples.slopes[n], kLeastSlope, kMostSlope);
            weights_.push_back(evidence.samples.areas_mm2[n] * evidence.shares[n] / slope);
        }
    }

    /// The best plane, which counts as drawn from now on; nullopt when all are too near to drawn ones or miss the object.
    std::optional<SuggestedPlane> next(PlaneSuggestions& cost) {
        if (options_.planes == PlaneChoice::any && plane_count_ >= kFirstByClusters &&
            plane_count_ < kFirstByClusters + kByClusters)
            if (const auto plane =
                    plane_through_far_places(evidence_.samples.points, distances_, kClusterReach * evidence_.size_mm)) {
                const Cut cut = cut_by(*plane, {});
                if (shows_more(cut)) return take(cut);
            }
        std::optional<Cut> best = best_of(candidates(), cost);
        if (!best) return std::nullopt;
        if (options_.planes == PlaneChoice::any) settle(*best, cost);
        return take(*best);
    }

    /// A plane chosen by another rule.
    SuggestedPlane take(const Cut& cut) {
        SuggestedPlane choice;
        choice.plane = cut.plane;
        choice.slice = cut.slice;
        std::int64_t count = 0;
        std::vector<double> after = distances_with(cut, count);
        const double all = remaining(distances_);
        choice.gain = all > 0 ? gain(after) / all : 0;
        if (evidence_.plane_count() >= kLeastPlanes) {
            choice.before = expected_dice(evidence_, distances_);
            choice.after = expected_dice(evidence_, after);
        }
        if (!cut.line.empty()) choice.plane.origin = middle_of(cut.line);
        distances_ = std::move(after);
        avoided_.push_back(cut.plane);
        ++plane_count_;
        return choice;
    }

    Cut cut_by(const Plane& plane, const std::optional<ImageSlice>& slice) const {
        Cut cut{.plane = plane, .slice = slice, .line = {}};
        for (const Vec3& p : evidence_.samples.points) {
            const double distance = plane.distance_to(p);
            if (std::abs(distance) < kSlab * evidence_.size_mm) cut.line.push_back(p - distance * plane.normal);
        }
        return cut;
    }

    bool is_copy(const Cut& cut) const {
        return std::any_of(avoided_.begin(), avoided_.end(), [&](const Plane& plane) { return copies(cut, plane); });
    }

private:
    std::vector<Cut> candidates() const {
        std::vector<Cut> cuts;
        for (const PlaneStack& stack : candidate_planes(evidence_.samples.points, options_.planes, options_.grid))
            for (std::size_t n = 0; n < stack.offsets_mm.size(); ++n) {
                const Plane plane = stack.slices.empty() ? make_plane(stack.offsets_mm[n] * stack.normal, stack.normal)
                                                         : slice_plane(*options_.grid, stack.slices[n]);
                add(cuts, cut_by(plane, stack.slices.empty() ? std::optional<ImageSlice>() : stack.slices[n]));
            }
        return cuts;
    }

    /// Whether the object would be seen in it, and not as it was seen already.
    bool shows_more(const Cut& cut) const { return cut.line.size() >= kLeastInCut && !is_copy(cut); }

    void add(std::vector<Cut>& cuts, Cut cut) const {
        if (shows_more(cut)) cuts.push_back(std::move(cut));
    }

    /// The first of equals; none where nothing is gained.
    std::optional<Cut> best_of(std::vector<Cut> cuts, PlaneSuggestions& cost) const {
        cost.candidates += static_cast<std::int64_t>(cuts.size());
        std::vector<std::int64_t> counts(cuts.size());
        parallel_for(static_cast<std::int64_t>(cuts.size()), 1, work_, [&](std::int64_t begin, std::int64_t end) {
            for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
                cuts[n].gain = gain(distances_with(cuts[n], counts[n]));
        });
        cost.distances += std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
        const auto best =
            std::max_element(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.gain < b.gain; });
        if (best == cuts.end() || !(best->gain > 0)) return std::nullopt;
        return std::move(*best);
    }

    /// Shifts and tilts a plane as long as that gains.
    void settle(Cut& best, PlaneSuggestions& cost) const {
        const std::array<Vec3, 3> axes = principal_axes(evidence_.samples.points);
        double shift = kFirstShift * evidence_.size_mm, tilt = kFirstTilt;
        for (int round = 0; round < kRounds; ++round, shift /= 2, tilt /= 2)
            for (int step = 0; step < kStepsPerRound; ++step) {
                const Vec3 middle = middle_of(best.line), normal = best.plane.normal;
                std::vector<Cut> beside;
                for (const double sign : {1.0, -1.0}) {
                    add(beside, cut_by(make_plane(middle + sign * shift * normal, normal), {}));
                    for (const Vec3& axis : axes)
                        add(beside, cut_by(make_plane(middle, normalized(normal + sign * tilt * axis)), {}));
                }
                std::optional<Cut> better = best_of(std::move(beside), cost);
                if (!better || !(better->gain > best.gain)) break;
                best = std::move(*better);
            }
    }

    bool copies(const Cut& cut, const Plane& plane) const {
        if (std::abs(dot(cut.plane.normal, plane.normal)) < kAlikeCosine) return false;
        const auto near = std::count_if(cut.line.begin(), cut.line.end(), [&](const Vec3& p) {
            return std::abs(plane.distance_to(p)) < kNearCopy * evidence_.size_mm;
        });
        return static_cast<double>(near) > kMostOfCut * static_cast<double>(cut.line.size());
    }

    /// Of all samples, if the cut's line were drawn. Farther from the plane than from a drawn line nothing changes.
    std::vector<double> distances_with(const Cut& cut, std::int64_t& count) const {
        std::vector<double> distances = distances_;
        for (std::size_t n = 0; n < distances.size(); ++n) {
            const Vec3& p = evidence_.samples.points[n];
            if (std::abs(cut.plane.distance_to(p)) >= distances[n]) continue;
            double squared = distances[n] * distances[n];
            for (const Vec3& q : cut.line) {
                const Vec3 d = p - q;
                squared = std::min(squared, dot(d, d));
            }
            count += static_cast<std::int64_t>(cut.line.size());
            distances[n] = std::sqrt(squared);
        }
        return distances;
    }

    double remaining(const std::vector<double>& distances) const {
        double sum = 0;
        for (std::size_t n = 0; n < distances.size(); ++n)
            sum += weights_[n] * std::max(distances[n] - kLeastDistance * evidence_.size_mm, 0.0);
        return sum;
    }
    double gain(const std::vector<double>& after) const { return remaining(distances_) - remaining(after); }

    const SurfaceEvidence& evidence_;
    const SuggestPlaneOptions& options_;
    const Work& work_;
    std::vector<Plane> avoided_;
    std::vector<double> distances_, weights_;
    std::size_t plane_count_ = evidence_.plane_count();  ///< drawn or taken
};

bool all_parallel(const std::vector<Plane>& planes) {
    return std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
        return std::abs(dot(plane.normal, planes.front().normal)) > kParallelCosine;
    });
}

/// The slice of the image nearest to a plane, across the axis that fits its normal best among those that lie across what was
/// drawn.
ImageSlice slice_like(const Grid& grid, const Plane& plane, const Plane& other) {
    int best = -1;
    const auto fit = [&](int axis) { return std::abs(dot(slice_normal(grid, axis), plane.normal)); };
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(dot(slice_normal(grid, axis), other.normal)) < 0.9 && (best < 0 || fit(axis) > fit(best))) best = axis;
    return nearest_slice(grid, best < 0 ? 0 : best, plane.origin);
}

Cut across(const Chooser& chooser, const SurfaceEvidence& evidence, const ContourSet& contours,
           const SuggestPlaneOptions& options) {
    const Plane plane = plane_across(contours);
    if (options.planes == PlaneChoice::any) return chooser.cut_by(plane, {});
    const ImageSlice slice = slice_like(*options.grid, plane, evidence.lines.planes().front());
    return chooser.cut_by(slice_plane(*options.grid, slice), slice);
}

}  // namespace

PlaneSuggestions suggest_planes(const SurfaceEvidence& evidence, const ContourSet& contours, std::size_t count,
                                const SuggestPlaneOptions& options, const Work& work) {
    if (evidence.plane_count() == 0)
        throw Error(ErrorKind::invalid_input, "there is no contour; at least 1 is needed to say where to draw next");
    if (count == 0) throw Error(ErrorKind::invalid_input, "0 planes are asked for; at least 1 is needed");
    if (options.planes == PlaneChoice::image_slices && !options.grid)
        throw Error(ErrorKind::invalid_input, "slices of an image are asked for, but there is no image");
    PlaneSuggestions suggestions;
    Chooser chooser(evidence, contours.empty_planes, options, work);
    if (all_parallel(evidence.lines.planes()))
        if (const Cut cut = across(chooser, evidence, contours, options); !chooser.is_copy(cut))
            suggestions.planes.push_back(chooser.take(cut));
    while (suggestions.planes.size() < count) {
        const std::optional<SuggestedPlane> next = chooser.next(suggestions);
        if (!next) break;
        suggestions.planes.push_back(*next);
    }
    return suggestions;
}

}  // namespace kontur
