// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/strands.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/smooth_step.h"

namespace kontur {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kCovered = 0.3;  // of a part: more of it over the other section, and the slices show the way themselves

using Sections = std::vector<std::uint8_t>;

struct Part {
    std::vector<std::size_t> voxels;  ///< places in the slice
    SectionField field;
    double u = 0, v = 0;  ///< the mean of the voxels' indices
};

/// The connected parts of a section.
std::vector<Part> parts_of(const Sections& section, std::int64_t width) {
    const std::int64_t height = static_cast<std::int64_t>(section.size()) / width;
    Sections rest = section;
    std::vector<Part> parts;
    for (std::size_t first = 0; first < rest.size(); ++first) {
        if (!rest[first]) continue;
        std::vector<std::size_t>& voxels = parts.emplace_back().voxels;
        voxels.push_back(first), rest[first] = 0;
        for (std::size_t n = 0; n < voxels.size(); ++n) {
            const auto place = static_cast<std::int64_t>(voxels[n]);
            const std::int64_t u = place % width, v = place / width;
            for (std::int64_t b = std::max<std::int64_t>(v - 1, 0); b <= std::min(v + 1, height - 1); ++b)
                for (std::int64_t a = std::max<std::int64_t>(u - 1, 0); a <= std::min(u + 1, width - 1); ++a) {
                    const auto next = static_cast<std::size_t>(a + width * b);
                    if (!rest[next]) continue;
                    rest[next] = 0, voxels.push_back(next);
                }
        }
    }
    return parts;
}

double share_over(const Part& part, const Sections& section) {
    const auto over = std::count_if(part.voxels.begin(), part.voxels.end(), [&](std::size_t n) { return section[n] != 0; });
    return static_cast<double>(over) / static_cast<double>(part.voxels.size());
}

/// Distances in the part's box, padded by as much as the part can be thick.
void measure(Part& part, const Grid& grid, const PaintedSlice& slice) {
    const auto [axis_u, axis_v] = slice_axes(slice.axis);
    const std::int64_t width = grid.size[axis_u], height = grid.size[axis_v];
    const Vec3 spacing = grid.spacing_mm();
    std::int64_t low_u = width, high_u = 0, low_v = height, high_v = 0;
    for (const std::size_t n : part.voxels) {
        const std::int64_t u = static_cast<std::int64_t>(n) % width, v = static_cast<std::int64_t>(n) / width;
        low_u = std::min(low_u, u), high_u = std::max(high_u, u), low_v = std::min(low_v, v), high_v = std::max(high_v, v);
        part.u += static_cast<double>(u), part.v += static_cast<double>(v);
    }
    const auto count = static_cast<double>(part.voxels.size());
    part.u /= count, part.v /= count;
    const std::int64_t margin = 1 + std::min(high_u - low_u + 1, high_v - low_v + 1) / 2;
    SectionField& field = part.field;
    field.left = low_u - margin, field.bottom = low_v - margin;
    field.width = high_u - low_u + 1 + 2 * margin, field.height = high_v - low_v + 1 + 2 * margin;
    field.step_u_mm = spacing[axis_u], field.step_v_mm = spacing[axis_v];
    SectionVoxels section{Sections(static_cast<std::size_t>(field.width * field.height)), field.width, field.step_u_mm,
                          field.step_v_mm};
    for (const std::size_t n : part.voxels) {
        const std::int64_t u = static_cast<std::int64_t>(n) % width, v = static_cast<std::int64_t>(n) / width;
        section.set[static_cast<std::size_t>(u - field.left + field.width * (v - field.bottom))] = 1;
    }
    const std::vector<double> distances = section_distances(section);
    field.mm.assign(distances.begin(), distances.end());
}

/// Those of which hardly anything lies over the other section.
std::vector<Part> loose_parts(const Grid& grid, const PaintedSlice& slice, const PaintedSlice& other) {
    std::vector<Part> parts = parts_of(slice.section, grid.size[slice_axes(slice.axis)[0]]);
    std::erase_if(parts, [&](const Part& part) { return share_over(part, other.section) > kCovered; });
    for (Part& part : parts) measure(part, grid, slice);
    return parts;
}

/// The largest depth in a part of another one's voxels: how far apart they are, negative, or how far they overlap.
double nearness_mm(const Part& part, const Part& other, std::int64_t width) {
    double nearest = -kFar;
    for (const std::size_t n : other.voxels)
        nearest = std::max(nearest, part.field.at(static_cast<double>(static_cast<std::int64_t>(n) % width),
                                                  static_cast<double>(static_cast<std::int64_t>(n) / width)));
    return nearest;
}

double belief_in(const Part& low, const Part& high, double nearness_mm, const PaintedSlice& below,
                 const PaintedSlice& above) {
    const double thinner_mm = 2 * std::min(low.field.thickest_mm(), high.field.thickest_mm());
    const double covered = std::max(share_over(low, above.section), share_over(high, below.section));
    return smooth_step(0, 1, 1.5 + nearness_mm / thinner_mm) * (1 - smooth_step(0, kCovered, covered));
}

/// Which of `count` is the largest; `count` when all are -infinity.
template <class Value>
std::size_t largest(std::size_t count, const Value& value) {
    std::size_t best = count;
    for (std::size_t n = 0; n < count; ++n)
        if (value(n) > (best < count ? value(best) : -kFar)) best = n;
    return best;
}

void take_away(const Part& part, Sections& section) {
    for (const std::size_t n : part.voxels) section[n] = 0;
}

}  // namespace

bool Strand::is_near(double along, double u, double v) const {
    const auto is_in = [](const SectionField& field, double a, double b) {
        return a >= static_cast<double>(field.left) && b >= static_cast<double>(field.bottom) &&
               a <= static_cast<double>(field.left + field.width - 1) &&
               b <= static_cast<double>(field.bottom + field.height - 1);
    };
    const double u_low = u - along * way_u, v_low = v - along * way_v;
    return is_in(low, u_low, v_low) || is_in(high, u_low + way_u, v_low + way_v);
}

double Strand::depth_mm(double along, double u, double v, double gap_mm) const {
    const double u_low = u - along * way_u, v_low = v - along * way_v;
    const double first = low.at(u_low, v_low), second = high.at(u_low + way_u, v_low + way_v);
    return std::lerp(first, second, along) / std::hypot(1.0, (second - first) / gap_mm);
}

Strands find_strands(const Grid& grid, const PaintedSlice& low, const PaintedSlice& high) {
    Strands strands{{}, low.section, high.section};
    const std::vector<Part> below = loose_parts(grid, low, high), above = loose_parts(grid, high, low);
    const std::int64_t width = grid.size[slice_axes(low.axis)[0]];
    std::vector<double> nearness(below.size() * above.size());
    for (std::size_t a = 0; a < below.size(); ++a)
        for (std::size_t b = 0; b < above.size(); ++b)
            nearness[a * above.size() + b] = nearness_mm(below[a], above[b], width);
    for (std::size_t a = 0; a < below.size(); ++a) {
        const std::size_t b = largest(above.size(), [&](std::size_t n) { return nearness[a * above.size() + n]; });
        if (b == above.size()) continue;
        if (largest(below.size(), [&](std::size_t n) { return nearness[n * above.size() + b]; }) != a) continue;
        const double belief = belief_in(below[a], above[b], nearness[a * above.size() + b], low, high);
        if (belief <= 0) continue;
        strands.strands.push_back(
            {below[a].field, above[b].field, above[b].u - below[a].u, above[b].v - below[a].v, belief});
        take_away(below[a], strands.low_rest), take_away(above[b], strands.high_rest);
    }
    return strands;
}

}  // namespace kontur
