// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/prepare.h"

#include <algorithm>
#include <cmath>

#include "kontur/field/orient.h"
#include "kontur/field/reduce.h"

namespace kontur {
namespace {

bool is_coplanar(const ContourSet& set) {
    const Plane& plane = set.contours.front().plane;
    const double tolerance = 1e-6 * bounding_box(set).diagonal();
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points)
            if (std::abs(plane.distance_to(p)) > std::max(tolerance, 1e-3)) return false;
    return true;
}

Contour shifted(Contour contour, const Vec3& by) {
    contour.plane.origin += by;
    for (Vec3& p : contour.points) p += by;
    return contour;
}

void append(const Contour& drawn, std::int32_t index, const PrepareOptions& options, PreparedContours& prepared) {
    const auto least_segments = static_cast<int>(std::ceil(options.quality * options.least_segments));
    const Contour contour = refine(reduce(drawn, {options.quality}), least_segments);
    const ContourOrientation orientation = orient(contour);
    for (std::size_t i = 0; i < contour.points.size(); ++i)
        prepared.points.push_back({contour.points[i], orientation.normals[i], contour.plane.normal, index});
    const auto append_to = [](std::vector<Vec3>& to, const std::vector<Vec3>& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append_to(prepared.crossings, orientation.crossings);
    append_to(prepared.between_crossings, orientation.between_crossings);
}

}  // namespace

PreparedContours prepare(const ContourSet& set, const PrepareOptions& options) {
    PreparedContours prepared;
    for (std::size_t c = 0; c < set.contours.size(); ++c)
        append(set.contours[c], static_cast<std::int32_t>(c), options, prepared);
    prepared.coplanar = !set.contours.empty() && is_coplanar(set);
    if (prepared.coplanar && options.copy_shift_mm > 0) {
        const Contour& first = set.contours.front();
        append(shifted(first, options.copy_shift_mm * first.plane.normal), 0, options, prepared);
    }
    if (options.caps) {
        prepared.caps = find_caps(set);
        prepared.leak_probes = find_leak_probes(set);
    }
    return prepared;
}

}  // namespace kontur
