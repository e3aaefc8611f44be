// SPDX-License-Identifier: Apache-2.0
#include "ways.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "kontur/sureness/far_places.h"
#include "kontur/sureness/suggest_plane.h"

namespace kontur {
namespace {

using Planes = std::vector<Plane>;

Plane across(const Truth& truth, int axis, double fraction) {
    Vec3 normal, origin = truth.centroid();
    normal[axis] = 1;
    origin[axis] = truth.box().min[axis] + fraction * truth.box().size()[axis];
    return make_plane(origin, normal);
}

/// Through the axial layer in which there is most of the object.
Plane first_plane(const Truth& truth) {
    const Grid& grid = truth.grid();
    std::vector<int> counts(static_cast<std::size_t>(grid.size.k));
    const Affine3 to_index = grid.index_to_mm.inverse();
    for (const Vec3& p : truth.places()) ++counts[static_cast<std::size_t>(std::lround(to_index.apply(p).z))];
    const auto largest = std::max_element(counts.begin(), counts.end()) - counts.begin();
    Vec3 origin = truth.centroid();
    origin.z = grid.center_mm(0, 0, largest).z;
    return make_plane(origin, {0, 0, 1});
}

std::mt19937 random_for(const Truth& truth) {
    std::seed_seq seed(truth.name().begin(), truth.name().end());
    return std::mt19937(seed);
}

Plane random_plane(const Truth& truth, std::mt19937& random) {
    std::normal_distribution<double> normal;
    const Vec3 direction{normal(random), normal(random), normal(random)};
    const Vec3& place = truth.places()[std::uniform_int_distribution<std::size_t>(0, truth.places().size() - 1)(random)];
    return make_plane(truth.centroid() + 0.7 * (place - truth.centroid()), direction);
}

/// Done when twice in a row there is nothing more to gain.
class Ending {
public:
    explicit Ending(const WayLimits& limits) : limits_(limits) {}
    bool is_reached(const Annotator& annotator) {
        const double dice = annotator.segmentation() ? annotator.truth().dice(annotator.segmentation()->mask) : 0;
        const bool both = std::min(dice, last_) > limits_.enough_dice;
        last_ = dice;
        return annotator.planes().size() >= limits_.most_planes || both;
    }

private:
    const WayLimits& limits_;
    double last_ = 0;
};

/// Plane after plane; the next one is chosen with what is known then.
template <class Next>
void one_by_one(const Truth& truth, const WayLimits& limits, const Report& report, bool is_shown, const Next& next) {
    Annotator annotator(truth, limits.use_image);
    Ending ending(limits);
    annotator.draw(first_plane(truth), false);
    report(annotator);
    while (!ending.is_reached(annotator)) {
        const std::optional<Plane> plane = next(annotator);
        if (!plane) return;
        annotator.draw(*plane, is_shown);
        report(annotator);
    }
}

/// For every count all planes anew.
template <class Set>
void all_anew(const Truth& truth, const WayLimits& limits, const Report& report, const Set& set) {
    Ending ending(limits);
    for (std::size_t count = 1; count <= limits.most_planes; ++count) {
        Annotator annotator(truth, limits.use_image);
        for (const Plane& plane : set(count)) annotator.draw(plane, false, false);
        annotator.fit();
        report(annotator);
        if (ending.is_reached(annotator)) return;
    }
}

Planes even(const Truth& truth, int axis, std::size_t count) {
    Planes planes;
    for (std::size_t n = 0; n < count; ++n)
        planes.push_back(across(truth, axis, (static_cast<double>(n) + 0.5) / static_cast<double>(count)));
    return planes;
}

Planes orthogonal(const Truth& truth, std::size_t count) {
    Planes planes;
    for (std::size_t n = 0; n < 3; ++n)
        for (const Plane& plane : even(truth, 2 - static_cast<int>(n), count / 3 + (count % 3 > n))) planes.push_back(plane);
    return planes;
}

std::optional<Plane> suggested(const Annotator& annotator, PlaneChoice choice) {
    if (!annotator.segmentation()) return std::nullopt;
    SuggestPlaneOptions options{choice, annotator.truth().grid()};
    options.avoid = annotator.planes();  // those in which there was nothing, too
    const PlaneSuggestions found = suggest_planes(annotator.evidence(), annotator.contours(), 1, options, {.threads = 1});
    if (found.planes.empty()) return std::nullopt;
    return found.planes.front().plane;
}

/// As MITK's plane proposer: through the middles of the three largest clusters of points far from all contours, or the best
/// plane through all of these points.
std::optional<Plane> by_clusters(const Annotator& annotator) {
    if (!annotator.segmentation()) return std::nullopt;
    const SurfaceEvidence& e = annotator.evidence();
    if (e.samples.points.empty()) return std::nullopt;
    if (const auto plane = plane_through_far_places(e.samples.points, e.distances_mm, 0.06 * e.size_mm)) return plane;
    const double most = *std::max_element(e.distances_mm.begin(), e.distances_mm.end());
    std::vector<Vec3> far;
    for (std::size_t n = 0; n < e.samples.points.size(); ++n)
        if (e.distances_mm[n] > most / 2) far.push_back(e.samples.points[n]);
    return fit_plane(far);
}

void suggestion(const Truth& truth, const WayLimits& limits, const Report& report, PlaneChoice choice) {
    one_by_one(truth, limits, report, true, [&](const Annotator& annotator) { return suggested(annotator, choice); });
}

/// Fractions of the extent in the order of an annotator who halves gaps.
void axial(const Truth& truth, const WayLimits& limits, const Report& report) {
    constexpr std::array kFractions{0.5,  0.125, 0.875, 0.3125, 0.6875, 0.22, 0.78, 0.41,
                                    0.59, 0.05,  0.95,  0.17,   0.83,   0.36, 0.64};
    all_anew(truth, limits, report, [&](std::size_t count) {
        Planes planes;
        for (std::size_t n = 0; n < count; ++n) planes.push_back(across(truth, 2, kFractions[n]));
        return planes;
    });
}

void random_oblique(const Truth& truth, const WayLimits& limits, const Report& report) {
    std::mt19937 random = random_for(truth);
    one_by_one(truth, limits, report, false,
               [&](const Annotator&) { return std::optional<Plane>(random_plane(truth, random)); });
}

void rule_then_random(const Truth& truth, const WayLimits& limits, const Report& report) {
    std::mt19937 random = random_for(truth);
    one_by_one(truth, limits, report, true, [&](const Annotator& annotator) {
        return annotator.planes().size() == 1 ? suggested(annotator, PlaneChoice::any)
                                              : std::optional<Plane>(random_plane(truth, random));
    });
}

}  // namespace

const std::map<std::string, std::function<void(const Truth&, const WayLimits&, const Report&)>>& ways() {
    static const std::map<std::string, std::function<void(const Truth&, const WayLimits&, const Report&)>> all{
        {"suggestion", [](auto& t, auto& l, auto& r) { suggestion(t, l, r, PlaneChoice::any); }},
        {"suggested slices", [](auto& t, auto& l, auto& r) { suggestion(t, l, r, PlaneChoice::image_slices); }},
        {"axial", axial},
        {"axial, re-spaced",
         [](auto& t, auto& l, auto& r) { all_anew(t, l, r, [&](std::size_t count) { return even(t, 2, count); }); }},
        {"orthogonal",
         [](auto& t, auto& l, auto& r) { all_anew(t, l, r, [&](std::size_t count) { return orthogonal(t, count); }); }},
        {"random oblique", random_oblique},
        {"rule, then random", rule_then_random},
        {"MITK's rule", [](auto& t, auto& l, auto& r) { one_by_one(t, l, r, true, by_clusters); }},
    };
    return all;
}

}  // namespace kontur
