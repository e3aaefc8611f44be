// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

constexpr int kDirections = 400;  ///< in which the surface's outermost points are looked for

/// The points farthest along a direction and against it.
std::pair<Vec3, Vec3> outermost(const std::vector<Vec3>& points, const Vec3& direction) {
    const auto [least, most] = std::minmax_element(
        points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) { return dot(a, direction) < dot(b, direction); });
    return {*least, *most};
}

/// The largest distance lies between two outermost points. Of some directions (a Fibonacci lattice on half of the sphere)
/// the best pair, which is then led on along its own direction until it grows no more.
std::pair<Vec3, Vec3> farthest(const std::vector<Vec3>& points) {
    std::vector<Vec3> candidates;
    for (int n = 0; n < kDirections; ++n) {
        const double z = (n + 0.5) / kDirections, r = std::sqrt(1 - z * z),
                     angle = n * std::numbers::pi * (3 - std::sqrt(5.0));
        const auto [a, b] = outermost(points, {r * std::cos(angle), r * std::sin(angle), z});
        candidates.insert(candidates.end(), {a, b});
    }
    std::pair<Vec3, Vec3> best{points.front(), points.front()};
    const auto length = [](const std::pair<Vec3, Vec3>& pair) { return distance(pair.first, pair.second); };
    for (const Vec3& a : candidates)
        for (const Vec3& b : candidates)
            if (distance(a, b) > length(best)) best = {a, b};
    while (length(best) > 0) {
        const std::pair<Vec3, Vec3> next = outermost(points, normalized(best.second - best.first));
        if (length(next) <= length(best)) break;
        best = next;
    }
    return best;
}

double area_mm2(const TriangleMesh& mesh) {
    double twice = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        twice += norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
    return 0.5 * twice;
}

}  // namespace

ValueStatistics value_statistics(const Mask& mask, const Image& image) {
    if (!(mask.grid == image.grid)) throw Error(ErrorKind::invalid_input, "the mask does not lie on the image's grid");
    ValueStatistics found;
    double mean = 0, squares = 0;  // Welford 1962
    for (std::size_t n = 0; n < mask.values.size(); ++n) {
        if (mask.values[n] == 0) continue;
        const double value = sample(image, n);
        if (!std::isfinite(value)) continue;
        found.least = found.voxels == 0 ? value : std::min(found.least, value);
        found.most = found.voxels == 0 ? value : std::max(found.most, value);
        const double before = value - mean;
        mean += before / static_cast<double>(++found.voxels);
        squares += before * (value - mean);
    }
    if (found.voxels == 0) return found;
    found.mean = mean;
    found.deviation = std::sqrt(squares / static_cast<double>(found.voxels));
    return found;
}

Statistics statistics(const TriangleMesh& mesh) {
    Statistics found;
    found.volume_ml = signed_volume_mm3(mesh) / 1000;
    found.surface_cm2 = area_mm2(mesh) / 100;
    if (mesh.points.empty()) return found;
    std::tie(found.from, found.to) = farthest(mesh.points);
    found.diameter_mm = distance(found.from, found.to);
    found.extent_mm = bounding_box(mesh.points).size();
    return found;
}

}  // namespace kontur::viewer
