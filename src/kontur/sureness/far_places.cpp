// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/far_places.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace kontur {
namespace {

constexpr double kFar = 0.5;  // of the farthest point's distance
constexpr double kOnALine = 1e-4;

std::vector<std::vector<Vec3>> clusters(std::vector<Vec3> points, double reach_mm) {
    std::vector<std::vector<Vec3>> places;
    while (!points.empty()) {
        std::vector<Vec3> cluster{points.back()};
        points.pop_back();
        for (std::size_t n = 0; n < cluster.size(); ++n) {
            const auto near = std::stable_partition(points.begin(), points.end(), [&, from = cluster[n]](const Vec3& p) {
                return distance(p, from) > reach_mm;
            });
            cluster.insert(cluster.end(), near, points.end());
            points.erase(near, points.end());
        }
        places.push_back(std::move(cluster));
    }
    return places;
}

Vec3 middle_of(const std::vector<Vec3>& points) {
    return std::accumulate(points.begin(), points.end(), Vec3{}) / static_cast<double>(points.size());
}

}  // namespace

std::optional<Plane> plane_through_far_places(std::span<const Vec3> points, std::span<const double> distances_mm,
                                              double reach_mm) {
    if (points.empty()) return std::nullopt;
    const double farthest = *std::max_element(distances_mm.begin(), distances_mm.end());
    std::vector<Vec3> far;
    for (std::size_t n = 0; n < points.size(); ++n)
        if (distances_mm[n] > kFar * farthest) far.push_back(points[n]);
    std::vector<std::vector<Vec3>> places = clusters(std::move(far), reach_mm);
    if (places.size() < 3) return std::nullopt;
    std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
    const Vec3 first = middle_of(places[0]), normal = cross(middle_of(places[1]) - first, middle_of(places[2]) - first);
    if (!(norm(normal) > kOnALine * reach_mm * reach_mm)) return std::nullopt;
    return make_plane(first, normal);
}

}  // namespace kontur
