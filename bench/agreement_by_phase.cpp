// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "agreement.h"
#include "kontur/phantom/drawing.h"
#include "organs.h"

namespace kontur {
namespace {

constexpr int kGaps[] = {6, 12};  // about, across an organ
constexpr int kPhases = 5;
constexpr double kUneven = 0.618;  // of a gap: else both ends of an organ would be as far from their last planes, together
constexpr std::size_t kPointsPerPlane = 200;

/// Planes across an axis as a scanner lays them, which does not look where the organ ends: the first one a share of a gap
/// above its lowest point.
std::vector<Plane> stack(const Box3& box, int axis, double gap, double phase) {
    std::vector<Plane> planes;
    Vec3 normal{};
    normal[axis] = 1;
    for (double height = phase * gap; height < box.size()[axis]; height += gap) {
        Vec3 origin = box.center();
        origin[axis] = box.min[axis] + height;
        planes.push_back(make_plane(origin, normal));
    }
    return planes;
}

/// Volumes beyond the first and the last drawn contour, in percent of the organ's.
struct BeyondEnds {
    double too_much = 0, too_little = 0;
};

BeyondEnds beyond_ends(const Mask& mask, const Mask& truth, const ContourSet& contours, int axis) {
    Box3 drawn;
    for (const Contour& contour : contours.contours)
        for (const Vec3& p : contour.points) drawn.extend(p);
    const Index3 size = truth.grid.size;
    double more = 0, less = 0, all = 0;
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 0; j < size.j; ++j)
            for (std::int64_t i = 0; i < size.i; ++i) {
                const auto at = static_cast<std::size_t>(truth.grid.offset(i, j, k));
                all += truth.values[at] != 0;
                const double height = truth.grid.center_mm(i, j, k)[axis];
                if (height >= drawn.min[axis] && height <= drawn.max[axis]) continue;
                more += mask.values[at] && !truth.values[at];
                less += truth.values[at] && !mask.values[at];
            }
    return {100 * more / all, 100 * less / all};
}

nlohmann::ordered_json row(const Organ& organ, int axis, int gaps, double phase) {
    const double gap = organ.box.size()[axis] / (gaps + kUneven);
    const std::vector<Plane> planes = stack(organ.box, axis, gap, phase);
    const ContourSet contours = draw_sections(organ.body, planes, kPointsPerPlane * planes.size());
    const Mask mask = segment(contours, organ.truth.grid).mask;
    const BeyondEnds ends = beyond_ends(mask, organ.truth, contours, axis);
    return {{"object", organ.body.name()},
            {"drawing", fmt::format("{}{} phase {:.1f}", "xyz"[axis], gaps, phase)},
            {"phase", phase},
            {"contours", contours.contours.size()},
            {"too_much_beyond_percent", ends.too_much},
            {"too_little_beyond_percent", ends.too_little},
            {"kontur", to_json(compare(mask, organ.truth))}};
}

}  // namespace

nlohmann::ordered_json agreement_by_phase() {
    auto rows = nlohmann::ordered_json::array();
    for (const Organ& organ : organs())
        for (int axis = 0; axis < 3; ++axis)
            for (const int gaps : kGaps) {
                fmt::print(stderr, "{} across {}, {} gaps\n", organ.body.name(), "xyz"[axis], gaps);
                for (int p = 0; p < kPhases; ++p) rows.push_back(row(organ, axis, gaps, (p + 0.5) / kPhases));
            }
    return rows;
}

}  // namespace kontur
