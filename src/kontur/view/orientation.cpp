// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/orientation.h"

#include <algorithm>
#include <numbers>

namespace kontur {
namespace {

int strongest_axis(const Vec3& d) {
    int strongest = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (std::abs(d[axis]) > std::abs(d[strongest])) strongest = axis;
    return strongest;
}

}  // namespace

std::string orientation_letters(const Vec3& direction) {
    constexpr const char* kSides[3] = {"RL", "AP", "IS"};
    constexpr double kSine15 = 0.2588;
    const Vec3 d = normalized(direction);
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return std::abs(d[a]) > std::abs(d[b]); });
    std::string letters;
    for (const int axis : axes)
        if (std::abs(d[axis]) > kSine15) letters += kSides[axis][d[axis] > 0 ? 1 : 0];
    return letters;
}

EdgeLetters edge_letters(const Plane& plane) {
    return {orientation_letters(-plane.u), orientation_letters(plane.u), orientation_letters(-plane.v),
            orientation_letters(plane.v)};
}

SliceKind slice_kind(const Vec3& normal) {
    constexpr std::array kinds{SliceKind::sagittal, SliceKind::coronal, SliceKind::axial};
    return kinds[strongest_axis(normal)];
}

double obliquity_deg(const Vec3& normal) {
    const Vec3 n = normalized(normal);
    return std::acos(std::min(1.0, std::abs(n[strongest_axis(n)]))) * 180 / std::numbers::pi;
}

Plane screen_plane(SliceKind kind, const Vec3& origin) {
    switch (kind) {
        case SliceKind::sagittal:
            return {origin, {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
        case SliceKind::coronal:
            return {origin, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
        case SliceKind::axial:
            break;
    }
    return {origin, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
}

}  // namespace kontur
