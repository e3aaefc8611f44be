// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/scattered.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "kontur/base/error.h"

namespace kontur {
namespace {

constexpr std::int64_t kLookedAt = 4'000'000;

struct Voxels {
    std::int64_t all = 0, lone = 0;
};

/// Whether a face neighbour has the same value.
template <class Samples>
bool has_like(const Samples& samples, const Grid& grid, const Index3& at) {
    const std::size_t here = grid.offset(at.i, at.j, at.k);
    for (int axis = 0; axis < 3; ++axis)
        for (const std::int64_t side : {-1, 1}) {
            Index3 next = at;
            next[axis] += side;
            if (next[axis] >= 0 && next[axis] < grid.size[axis] &&
                samples[grid.offset(next.i, next.j, next.k)] == samples[here])
                return true;
        }
    return false;
}

template <class Samples>
std::unordered_map<std::int64_t, Voxels> look(const Samples& samples, const Grid& grid) {
    std::unordered_map<std::int64_t, Voxels> by_label;
    const std::int64_t rows = grid.size.j * grid.size.k;
    const std::int64_t step = 1 + rows * grid.size.i / kLookedAt;
    for (std::int64_t row = 0; row < rows; row += step)
        for (Index3 at{0, row % grid.size.j, row / grid.size.j}; at.i < grid.size.i; ++at.i) {
            const auto value = samples[grid.offset(at.i, at.j, at.k)];
            if (value == 0) continue;
            Voxels& voxels = by_label[static_cast<std::int64_t>(value)];
            ++voxels.all;
            voxels.lone += !has_like(samples, grid, at);
        }
    return by_label;
}

}  // namespace

std::optional<std::string> why_no_labels(const Image& labels) {
    const auto by_label = std::visit([&](const auto& samples) { return look(samples, labels.grid); }, labels.samples);
    const auto scattered = std::count_if(by_label.begin(), by_label.end(),
                                         [](const auto& one) { return 2 * one.second.lone > one.second.all; });
    if (2 * static_cast<std::size_t>(scattered) <= by_label.size()) return std::nullopt;
    return fmt::format("{} of its {} labels are scattered: most of their voxels have no neighbour with the same label",
                       scattered, by_label.size());
}

void check_no_image(const Image& labels, std::size_t count) {
    constexpr std::size_t kMany = 32;
    if (count < kMany) return;
    if (const auto why = why_no_labels(labels))
        throw Error(ErrorKind::invalid_input, fmt::format("this looks like an image, not like a label map: {}", *why));
}

}  // namespace kontur
