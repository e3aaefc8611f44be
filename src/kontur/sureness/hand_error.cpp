// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/hand_error.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/point_tree.h"
#include "kontur/sampling/drawn_lines.h"
#include "kontur/sampling/quantile.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/predicates.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

constexpr double kParallelCosine = 0.99939;  // 2 degrees
constexpr double kStep = 0.004;              // of the diameter, between the points of a line
constexpr double kPoints = 60;               // of each plane
constexpr std::size_t kReach = 2;            // planes off on either side
constexpr std::size_t kMostPlanes = 24, kLeastTriples = 4;
// Of the error of a straight line over the gap: the median over 39 structures drawn exactly in axial planes.
constexpr double kGrowth = 1.55;
constexpr double kLeastError = 1e-4;  // of the diameter: what lines are not better known than
constexpr int kShares = 40;
constexpr double kOfOthers = 8;  // radii of a section away are lines of other parts, such as other lesions

/// What was drawn in a plane of a stack, in the stack's (u, v).
class StackSection {
public:
    StackSection(const std::vector<const Contour*>& contours, const Plane& frame, double step_mm) : tree_({}) {
        double height = 0;
        for (const Contour* contour : contours) {
            Polygon2 outline;
            for (const Vec3& p : contour->points) outline.push_back(frame.to_uv(p));
            outlines_.push_back(std::move(outline));
            for (const Vec3& p : dense_points(*contour, step_mm)) {
                points_.push_back(frame.to_uv(p));
                height += frame.distance_to(p);
            }
        }
        height_mm_ = height / static_cast<double>(points_.size());
        std::vector<Vec3> flat;
        for (const Point2& p : points_) flat.push_back({p[0], p[1], 0});
        tree_ = PointTree(std::move(flat));
    }

    double height_mm() const { return height_mm_; }

    /// Of a circle that encloses as much.
    double radius_mm() const {
        double enclosed = 0;
        for (const Polygon2& outline : outlines_) enclosed += area(outline);
        return std::sqrt(enclosed / M_PI);
    }

    std::vector<Point2> some_points() const {
        const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(static_cast<double>(points_.size()) / kPoints));
        std::vector<Point2> some;
        for (std::size_t n = 0; n < points_.size(); n += step) some.push_back(points_[n]);
        return some;
    }

    /// Distance from the lines, positive inside.
    double depth_mm(const Point2& p) const {
        const auto around = std::count_if(outlines_.begin(), outlines_.end(),
                                          [&](const Polygon2& outline) { return is_inside(outline, p); });
        const double distance = tree_.distance_to({p[0], p[1], 0});
        return around % 2 == 1 ? distance : -distance;
    }

private:
    std::vector<Polygon2> outlines_;
    std::vector<Point2> points_;
    PointTree tree_;
    double height_mm_ = 0;
};

/// The sections of the largest stack of parallel planes in which every contour is closed, from below.
std::vector<StackSection> largest_stack(const ContourSet& set, double diameter_mm) {
    const std::vector<std::size_t> plane = shared_planes(set.contours, kSamePlane * diameter_mm);
    std::vector<std::vector<const Contour*>> by_plane(set.contours.size());
    for (std::size_t c = 0; c < plane.size(); ++c) by_plane[plane[c]].push_back(&set.contours[c]);
    std::erase_if(by_plane, [](const auto& group) {
        return group.empty() ||
               std::any_of(group.begin(), group.end(), [](const Contour* c) { return !c->closed || c->points.size() < 3; });
    });
    const auto parallel = [](const auto& a, const auto& b) {
        return std::abs(dot(a.front()->plane.normal, b.front()->plane.normal)) > kParallelCosine;
    };
    const std::vector<const Contour*>* first = nullptr;
    std::ptrdiff_t most = 0;
    for (const auto& group : by_plane) {
        const auto count =
            std::count_if(by_plane.begin(), by_plane.end(), [&](const auto& o) { return parallel(group, o); });
        if (count > most) first = &group;
        most = std::max(most, count);
    }
    std::vector<StackSection> stack;
    if (!first) return stack;
    const Plane frame = make_plane(first->front()->points.front(), first->front()->plane.normal);
    for (const auto& group : by_plane)
        if (parallel(*first, group)) stack.emplace_back(group, frame, kStep * diameter_mm);
    std::stable_sort(stack.begin(), stack.end(),
                     [](const StackSection& a, const StackSection& b) { return a.height_mm() < b.height_mm(); });
    return stack;
}

/// How far a plane's line is from the straight line between two others.
struct Triple {
    double variance_mm2;
    double of_hand;  ///< what a hand's variance of 1 would make of it
    double gap_mm2;  ///< the product of the gaps
};

void add_triples(const std::vector<StackSection>& stack, std::size_t middle, double least_mm, std::vector<Triple>& triples) {
    const std::vector<Point2> points = stack[middle].some_points();
    const std::size_t low = middle - std::min(middle, kReach), high = std::min(middle + kReach, stack.size() - 1);
    std::vector<std::vector<double>> depths(high - low + 1);
    for (std::size_t n = low; n <= high; ++n)
        if (n != middle)
            for (const Point2& p : points) depths[n - low].push_back(stack[n].depth_mm(p));
    for (std::size_t below = low; below < middle; ++below)
        for (std::size_t above = middle + 1; above <= high; ++above) {
            const double a = stack[middle].height_mm() - stack[below].height_mm(),
                         b = stack[above].height_mm() - stack[middle].height_mm();
            if (!(a > least_mm && b > least_mm)) continue;
            std::vector<double> errors, farther;
            for (std::size_t p = 0; p < points.size(); ++p) {
                const double from = depths[below - low][p], to = depths[above - low][p], slope = (to - from) / (a + b);
                farther.push_back(std::max(std::abs(from), std::abs(to)));
                errors.push_back(std::abs(b * from + a * to) / (a + b) / std::hypot(1, slope));
            }
            if (median(std::move(farther)) > kOfOthers * stack[middle].radius_mm()) continue;
            const double error = kDeviationOfMedian * median(std::move(errors));
            triples.push_back({error * error + least_mm * least_mm, 1 + (a * a + b * b) / ((a + b) * (a + b)), a * b});
        }
}

/// The hand's variance: of all mixtures of what grows with the gaps and what does not the one that is nearest, by absolute
/// differences of logarithms, so that a few planes between which the object branches do not matter.
double nugget(const std::vector<Triple>& triples) {
    double mean_log_gap = 0;
    for (const Triple& t : triples) mean_log_gap += std::log(t.gap_mm2) / static_cast<double>(triples.size());
    double least = INFINITY, variance = 0;
    for (int n = 0; n <= kShares; ++n) {
        const double share = std::pow(static_cast<double>(n) / kShares, 2);
        std::vector<double> logs;
        for (const Triple& t : triples)
            logs.push_back(
                std::log(t.variance_mm2 /
                         (share * t.of_hand + (1 - share) * std::exp(kGrowth * (std::log(t.gap_mm2) - mean_log_gap)))));
        const double middle = median(logs);
        double off = 0;
        for (const double l : logs) off += std::abs(l - middle);
        if (off < least) {
            least = off;
            variance = share * std::exp(middle);
        }
    }
    return variance;
}

}  // namespace

double parallel_hand_mm(const ContourSet& contours) {
    const double diameter = diameter_mm(contours);
    const std::vector<StackSection> stack = largest_stack(contours, diameter);
    if (stack.size() < 3) return 0;
    std::vector<Triple> triples;
    const std::size_t inner = stack.size() - 2, count = std::min(inner, kMostPlanes);
    for (std::size_t n = 0; n < count; ++n)
        add_triples(stack, 1 + (2 * n + 1) * inner / (2 * count), kLeastError * diameter, triples);
    return triples.size() < kLeastTriples ? 0 : std::sqrt(nugget(triples));
}

}  // namespace kontur
