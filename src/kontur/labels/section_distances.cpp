// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/section_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kontur {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Values of a row of voxels, `stride` apart in memory and `step_mm` in space.
struct Row {
    double* values;
    std::int64_t count, stride;
    double step_mm;
};

struct Scratch {
    std::vector<double> row, borders;
    std::vector<std::int64_t> parabolas;
};

/// Along one row: the least of squared distances to other voxels plus what these have.
void transform_row(const Row& line, Scratch& scratch) {
    const auto& [values, count, stride, step_mm] = line;
    auto& [row, borders, parabolas] = scratch;
    row.resize(static_cast<std::size_t>(count));
    parabolas.clear(), borders.clear();
    const auto at = [&values_of_row = row](std::int64_t n) { return values_of_row[static_cast<std::size_t>(n)]; };
    const auto place = [step = step_mm](std::int64_t n) { return step * static_cast<double>(n); };
    for (std::int64_t n = 0; n < count; ++n) row[static_cast<std::size_t>(n)] = values[n * stride];
    for (std::int64_t n = 0; n < count; ++n) {
        if (at(n) == kFar) continue;
        double border = -kFar;
        while (!parabolas.empty()) {
            const std::int64_t m = parabolas.back();
            border = (at(n) + place(n) * place(n) - at(m) - place(m) * place(m)) / (2 * (place(n) - place(m)));
            if (border > borders.back()) break;
            parabolas.pop_back(), borders.pop_back();
            border = -kFar;
        }
        parabolas.push_back(n), borders.push_back(border);
    }
    if (parabolas.empty()) return;
    for (std::int64_t n = 0, which = 0; n < count; ++n) {
        while (which + 1 < static_cast<std::int64_t>(parabolas.size()) &&
               borders[static_cast<std::size_t>(which + 1)] < place(n))
            ++which;
        const std::int64_t m = parabolas[static_cast<std::size_t>(which)];
        values[n * stride] = (place(n) - place(m)) * (place(n) - place(m)) + at(m);
    }
}

/// Squared distances to the nearest voxel that is set.
std::vector<double> squared_distances(const std::vector<std::uint8_t>& section, std::uint8_t set, std::int64_t width,
                                      double step_u_mm, double step_v_mm) {
    std::vector<double> squared(section.size());
    std::transform(section.begin(), section.end(), squared.begin(),
                   [&](std::uint8_t value) { return value == set ? 0.0 : kFar; });
    const std::int64_t height = static_cast<std::int64_t>(section.size()) / width;
    Scratch scratch;
    for (std::int64_t b = 0; b < height; ++b) transform_row({squared.data() + b * width, width, 1, step_u_mm}, scratch);
    for (std::int64_t a = 0; a < width; ++a) transform_row({squared.data() + a, height, width, step_v_mm}, scratch);
    return squared;
}

}  // namespace

std::vector<double> section_distances(const SectionVoxels& section) {
    const double half = std::min(section.step_u_mm, section.step_v_mm) / 2;
    const std::vector<double> outside =
        squared_distances(section.set, 1, section.width, section.step_u_mm, section.step_v_mm);
    const std::vector<double> inside =
        squared_distances(section.set, 0, section.width, section.step_u_mm, section.step_v_mm);
    std::vector<double> distances(section.set.size());
    for (std::size_t n = 0; n < distances.size(); ++n)
        distances[n] = section.set[n] ? std::sqrt(inside[n]) - half : half - std::sqrt(outside[n]);
    return distances;
}

std::vector<double> section_distances(const Grid& grid, const PaintedSlice& slice) {
    const auto [u, v] = slice_axes(slice.axis);
    const Vec3 spacing = grid.spacing_mm();
    return section_distances({slice.section, grid.size[u], spacing[u], spacing[v]});
}

double SectionField::at(double u, double v) const {
    const double a = u - static_cast<double>(left), b = v - static_cast<double>(bottom);
    const double inner_a = std::clamp(a, 0.0, static_cast<double>(width - 1)),
                 inner_b = std::clamp(b, 0.0, static_cast<double>(height - 1));
    const auto low_a = static_cast<std::int64_t>(inner_a), low_b = static_cast<std::int64_t>(inner_b);
    const auto value = [&](std::int64_t i, std::int64_t j) {
        return double{mm[static_cast<std::size_t>(std::min(i, width - 1) + width * std::min(j, height - 1))]};
    };
    const double part_a = inner_a - static_cast<double>(low_a), part_b = inner_b - static_cast<double>(low_b);
    const double inner = std::lerp(std::lerp(value(low_a, low_b), value(low_a + 1, low_b), part_a),
                                   std::lerp(value(low_a, low_b + 1), value(low_a + 1, low_b + 1), part_a), part_b);
    return inner - std::hypot((a - inner_a) * step_u_mm, (b - inner_b) * step_v_mm);
}

double SectionField::thickest_mm() const { return *std::max_element(mm.begin(), mm.end()); }

}  // namespace kontur
