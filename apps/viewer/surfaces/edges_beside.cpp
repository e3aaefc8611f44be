// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/edges_beside.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/image/intensities.h"

namespace kontur::viewer {
namespace {

// In voxels. Of 307 outlines of organs in CT and MR 2.9 % are named, and of those drawn 3 voxels too far inside 96 %;
// with 1.5 times 9.4 and 97 %, with 4 times 0.7 and 88 %.
constexpr double kTimesStronger = 2;
constexpr double kOnLine = 1, kBeside = 2, kReach = 5;
constexpr double kStep = 0.5;

/// Where the line is looked at, and which way is out.
struct Place {
    Vec3 at, outward;
};

double signed_area_mm2(const Contour& contour) {
    const Vec3& origin = contour.points.front();
    double area = 0;
    for (std::size_t i = 1; i + 1 < contour.points.size(); ++i)
        area += dot(cross(contour.points[i] - origin, contour.points[i + 1] - origin), contour.plane.normal) / 2;
    return area;
}

double length_mm(const Contour& contour) {
    double length = 0;
    for (std::size_t i = 0; i < contour.points.size(); ++i)
        length += distance(contour.points[i], contour.points[(i + 1) % contour.points.size()]);
    return length;
}

/// In the middle of pieces of at most `step_mm`.
std::vector<Place> places_on(const Contour& contour, double step_mm) {
    const double turn = signed_area_mm2(contour) < 0 ? -1 : 1;
    std::vector<Place> places;
    for (std::size_t i = 0; i < contour.points.size(); ++i) {
        const Vec3 &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
        const double length = distance(a, b);
        if (!(length > 0)) continue;
        const Vec3 outward = turn / length * cross(b - a, contour.plane.normal);
        const int pieces = std::max(1, static_cast<int>(std::ceil(length / step_mm)));
        for (int n = 0; n < pieces; ++n) places.push_back({a + (n + 0.5) / pieces * (b - a), outward});
    }
    return places;
}

/// How much the image changes across lines that run at this distance along the contour: mean over the places.
double mean_change(const std::vector<Place>& places, double offset_mm, const Intensities& intensities) {
    const double half_mm = 0.5 * intensities.voxel_mm();
    double sum = 0;
    std::size_t count = 0;
    for (const Place& place : places) {
        const double change = intensities.at(place.at + (offset_mm + half_mm) * place.outward) -
                              intensities.at(place.at + (offset_mm - half_mm) * place.outward);
        if (!std::isfinite(change)) continue;
        sum += std::abs(change);
        ++count;
    }
    return 2 * count > places.size() ? sum / static_cast<double>(count) : 0;
}

}  // namespace

std::optional<double> offset_of_edges(const Contour& contour, const Image& image) {
    if (!contour.closed || contour.points.size() < 3) return std::nullopt;
    const Intensities intensities(image);
    const double voxel_mm = intensities.voxel_mm(), length = length_mm(contour);
    // Not beyond the middle of what it encloses, where the other side's edges are; 2 area / length is a circle's radius.
    const double deepest_mm = std::min(kReach * voxel_mm, 1.8 * std::abs(signed_area_mm2(contour)) / length);
    const auto places = places_on(contour, std::max(voxel_mm, length / 200));
    double on_line = 0, strongest = 0, offset_mm = 0;
    for (double step = -kReach; step <= kReach; step += kStep) {
        if (-step * voxel_mm > deepest_mm) continue;
        const double change = mean_change(places, step * voxel_mm, intensities);
        if (std::abs(step) <= kOnLine) on_line = std::max(on_line, change);
        if (std::abs(step) >= kBeside && change > strongest) strongest = change, offset_mm = step * voxel_mm;
    }
    if (strongest == 0 || strongest < kTimesStronger * on_line) return std::nullopt;
    return (contour.hole ? -1 : 1) * offset_mm;
}

std::vector<EdgeBeside> edges_beside(const ContourSet& set, const std::vector<Id>& ids, const Image& image) {
    std::vector<EdgeBeside> found;
    for (std::size_t i = 0; i < set.contours.size(); ++i)
        if (const auto offset = offset_of_edges(set.contours[i], image)) found.push_back({ids.at(i), *offset});
    std::ranges::stable_sort(found, std::ranges::greater(), [](const EdgeBeside& one) { return std::abs(one.offset_mm); });
    return found;
}

}  // namespace kontur::viewer
