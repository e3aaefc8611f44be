// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/mesh_code.h"

#include <algorithm>
#include <cmath>

namespace kontur::viewer {
namespace {

constexpr double kMostSteps = 65'535;

std::uint32_t zigzag(std::int64_t difference) {
    return static_cast<std::uint32_t>(difference < 0 ? -2 * difference - 1 : 2 * difference);
}

/// Both wrap around, so that differences fit into as many bits as the numbers.
std::uint16_t zigzag16(std::uint16_t from, std::uint16_t to) {
    return static_cast<std::uint16_t>(zigzag(static_cast<std::int16_t>(static_cast<std::uint16_t>(to - from))));
}

std::uint8_t zigzag8(std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(zigzag(static_cast<std::int8_t>(static_cast<std::uint8_t>(to - from))));
}

/// From the unit sphere to a square, -1 to 1 along each side.
std::array<double, 2> octahedral(const Vec3& n) {
    const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    const double u = n.x / sum, v = n.y / sum;
    if (n.z >= 0) return {u, v};
    return {std::copysign(1 - std::abs(v), u), std::copysign(1 - std::abs(u), v)};
}

void append(std::vector<std::uint8_t>& bytes, std::uint32_t number) {
    for (; number > 127; number >>= 7) bytes.push_back(static_cast<std::uint8_t>(number | 128));
    bytes.push_back(static_cast<std::uint8_t>(number));
}

void add_positions(MeshCode& code, const std::vector<Vec3>& points) {
    const Box3 box = bounding_box(points);
    code.origin = box.min;
    code.step_mm = (1 / kMostSteps) * box.size();
    const std::size_t count = points.size();
    code.positions.resize(6 * count);
    for (int axis = 0; axis < 3; ++axis) {
        const double scale = code.step_mm[axis] > 0 ? 1 / code.step_mm[axis] : 0;
        std::uint8_t* low = code.positions.data() + 2 * count * static_cast<std::size_t>(axis);
        std::uint16_t before = 0;
        for (std::size_t n = 0; n < count; ++n) {
            const auto here = static_cast<std::uint16_t>(std::lround((points[n][axis] - code.origin[axis]) * scale));
            const std::uint16_t difference = zigzag16(before, here);
            low[n] = static_cast<std::uint8_t>(difference);
            low[count + n] = static_cast<std::uint8_t>(difference >> 8);
            before = here;
        }
    }
}

void add_normals(MeshCode& code, const std::vector<Vec3>& normals) {
    code.normals.resize(2 * normals.size());
    std::array<std::uint8_t, 2> before{};
    for (std::size_t n = 0; n < normals.size(); ++n) {
        const std::array<double, 2> square = octahedral(normals[n]);
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const auto here = static_cast<std::uint8_t>(std::lround(127.5 * (square[axis] + 1)));
            code.normals[axis * normals.size() + n] = zigzag8(before[axis], here);
            before[axis] = here;
        }
    }
}

}  // namespace

MeshCode code_mesh(const TriangleMesh& mesh) {
    MeshCode code;
    if (mesh.points.empty()) return code;
    add_positions(code, mesh.points);
    add_normals(code, mesh.normals);
    code.triangles.reserve(6 * mesh.triangles.size());
    std::int64_t before = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        append(code.triangles, zigzag(a - before));
        append(code.triangles, zigzag(std::int64_t{b} - a));
        append(code.triangles, zigzag(std::int64_t{c} - a));
        before = a;
    }
    return code;
}

WidthCode code_widths(std::span<const double> widths_mm) {
    constexpr double kMost = 255;
    WidthCode code;
    if (widths_mm.empty()) return code;
    code.step_mm = *std::max_element(widths_mm.begin(), widths_mm.end()) / kMost;
    for (const double width : widths_mm)
        code.steps.push_back(static_cast<std::uint8_t>(code.step_mm > 0 ? std::lround(width / code.step_mm) : 0));
    return code;
}

WidthCode code_distances(std::span<const double> distances_mm) {
    constexpr double kMost = 127, kZero = 128;
    WidthCode code;
    for (const double distance : distances_mm) code.step_mm = std::max(code.step_mm, std::abs(distance) / kMost);
    for (const double distance : distances_mm)
        code.steps.push_back(
            static_cast<std::uint8_t>(kZero + (code.step_mm > 0 ? std::round(distance / code.step_mm) : 0)));
    return code;
}

}  // namespace kontur::viewer
