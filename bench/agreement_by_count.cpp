// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>
#include <vector>

#include "agreement.h"
#include "kontur/phantom/drawing.h"
#include "organs.h"

namespace kontur {
namespace {

constexpr int kCounts[] = {3, 4, 5, 6, 7, 8, 10, 12, 14, 17, 20};
constexpr int kMostPlanes = 20;
constexpr std::size_t kPointsPerPlane = 120;

/// Evenly spaced across an axis, as far from the ends of the box as it is dense.
std::vector<Plane> across(const Box3& box, int axis, int count) {
    std::vector<Plane> planes;
    Vec3 normal{};
    normal[axis] = 1;
    for (int i = 0; i < count; ++i) {
        Vec3 origin = box.center();
        origin[axis] = box.min[axis] + box.size()[axis] * (i + 0.9) / (count + 0.8);
        planes.push_back(make_plane(origin, normal));
    }
    return planes;
}

std::vector<Plane> axial(const Box3& box, int count) { return across(box, 2, count); }

std::vector<Plane> orthogonal(const Box3& box, int count) {
    std::vector<Plane> planes;
    for (int axis = 0; axis < 3; ++axis)
        for (const Plane& plane : across(box, axis, (count + axis) / 3)) planes.push_back(plane);
    return planes;
}

/// In random directions through random points of the middle half of the box. More planes are the same ones and others.
std::vector<Plane> oblique(const Box3& box, int count, int series) {
    Random random(seed_of(fmt::format("oblique {}", series)));
    std::vector<Plane> planes;
    for (int i = 0; i < kMostPlanes; ++i) {
        const Vec3 normal{random.gaussian(), random.gaussian(), random.gaussian()};
        Vec3 at = box.center();
        for (int axis = 0; axis < 3; ++axis) at[axis] += random.uniform(-0.25, 0.25) * box.size()[axis];
        planes.push_back(make_plane(at, normal));
    }
    planes.resize(static_cast<std::size_t>(count));
    return planes;
}

nlohmann::ordered_json row(const Organ& organ, const std::string& direction, int series, const std::vector<Plane>& planes) {
    const ContourSet contours = draw_sections(organ.body, planes, kPointsPerPlane * planes.size());
    const auto agreement = [&](const SegmentOptions& options) {
        return to_json(compare(segment(contours, organ.truth.grid, options).mask, organ.truth));
    };
    return {{"object", organ.body.name()},
            {"direction", direction},
            {"series", series},
            {"planes", planes.size()},
            {"contours", contours.contours.size()},
            {"kontur", agreement({})},
            {"paper", agreement(as_printed())}};
}

}  // namespace

nlohmann::ordered_json agreement_by_count() {
    constexpr int kSeries = 3;
    auto rows = nlohmann::ordered_json::array();
    for (const Organ& organ : organs()) {
        for (const int count : kCounts) {
            fmt::print(stderr, "{}, {} planes\n", organ.body.name(), count);
            rows.push_back(row(organ, "axial", 1, axial(organ.box, count)));
            rows.push_back(row(organ, "orthogonal", 1, orthogonal(organ.box, count)));
            for (int series = 1; series <= kSeries; ++series)
                rows.push_back(row(organ, "oblique", series, oblique(organ.box, count, series)));
        }
    }
    return rows;
}

}  // namespace kontur
