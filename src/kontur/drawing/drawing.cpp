// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/drawing.h"

#include <fmt/format.h>

#include <utility>

namespace kontur {
namespace {

void note_filling(const FillChanges& changes, std::vector<std::string>& notes) {
    if (changes.holes > 0) notes.push_back(fmt::format("{} contours inside others became holes", changes.holes));
    if (changes.removed > 0)
        notes.push_back(fmt::format("{} contours inside the object were left out: they are not holes", changes.removed));
    if (!changes.stray_holes.empty())
        notes.push_back(
            fmt::format("{} contours are holes where nothing is drawn around them, the first of them "
                        "contour {}",
                        changes.stray_holes.size(), changes.stray_holes.front() + 1));
    for (const auto& [a, b] : changes.crossings)
        notes.push_back(fmt::format("contours {} and {} overlap in part", a + 1, b + 1));
}

}  // namespace

Drawing::Drawing(ContourSet drawn, FillRule rule) : contours(std::move(drawn)) {
    if (const std::size_t dropped = drop_duplicate_points(contours); dropped > 0)
        notes.push_back(fmt::format("{} repeated points were left out", dropped));
    check_contours(contours);
    note_filling(apply_fill_rule(contours, rule), notes);
    ball = smallest_ball(contours);
    crossings = find_crossings(contours);
}

}  // namespace kontur
