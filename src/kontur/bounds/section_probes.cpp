// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/section_probes.h"

#include <algorithm>
#include <cmath>

#include "kontur/drawing/each_of_many.h"
#include "kontur/shape/box_tree.h"
#include "kontur/shape/enclosed_area.h"

namespace kontur {
namespace {

template <class Visit>
void for_each_edge_of_all(const Section& section, const Visit& visit) {
    for (const Polygon2& outline : section.outlines) for_each_edge(outline, visit);
}

/// The box of an outline along axes, and what it encloses.
struct Outline {
    Box2 box;
    double area = 0;
};

Outline outline_along(const SectionAxes& axes, const Polygon2& polygon) {
    Outline outline;
    for (const Point2& vertex : polygon) outline.box.extend(axes.from_plane(vertex));
    outline.area = enclosed_area(polygon);
    return outline;
}

/// Whether that outline is the first but holes that encloses the place.
bool belongs_to(const Section& section, const SectionSearch& search, std::size_t outline, const Point2& at) {
    std::size_t first = section.outlines.size();
    search.visit_around(at, [&](std::size_t o) {
        if (section.layer(o) > 0) first = std::min(first, o);
    });
    return first == outline;
}

}  // namespace

std::vector<double> areas_without_holes(const Section& section) {
    constexpr double kLeast = 1e-6;  // of what it encloses with them: holes may lie beside what they are cut from
    std::vector<double> areas;
    for (std::size_t o = 0; o < section.outlines.size(); ++o) {
        areas.push_back(section.layer(o) > 0 ? enclosed_area(section.outlines[o]) : 0);
        const double least = kLeast * areas.back();
        for (std::size_t hole = 0; hole < section.outlines.size(); ++hole)
            if (section.layer(o) > 0 && section.layer(hole) < 0 &&
                is_inside(section.outlines[o], section.outlines[hole].front()))
                areas.back() -= enclosed_area(section.outlines[hole]);
        areas.back() = std::max(areas.back(), least);
    }
    return areas;
}

SectionAxes::SectionAxes(const Section& section) {
    // Moments of the lines, each edge as a mass at its middle.
    double mass = 0, mean_u = 0, mean_v = 0;
    const auto middle = [](const Point2& a, const Point2& b) { return Point2{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}; };
    const auto length = [](const Point2& a, const Point2& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); };
    for_each_edge_of_all(section, [&](const Point2& a, const Point2& b) {
        mass += length(a, b);
        mean_u += length(a, b) * middle(a, b)[0];
        mean_v += length(a, b) * middle(a, b)[1];
    });
    if (!(mass > 0)) return;
    double uu = 0, uv = 0, vv = 0;
    for_each_edge_of_all(section, [&](const Point2& a, const Point2& b) {
        const double u = middle(a, b)[0] - mean_u / mass, v = middle(a, b)[1] - mean_v / mass;
        uu += length(a, b) * u * u;
        uv += length(a, b) * u * v;
        vv += length(a, b) * v * v;
    });
    const bool is_round = std::hypot(uu - vv, 2 * uv) < 1e-3 * (uu + vv);
    const Point2& first = section.outlines.front().front();
    const double angle =
        is_round ? std::atan2(first[1] - mean_v / mass, first[0] - mean_u / mass) : std::atan2(2 * uv, uu - vv) / 2;
    cos_ = std::cos(angle);
    sin_ = std::sin(angle);
}

std::vector<Probe> probes(const Section& section) {
    constexpr double kProbes = 118;        // of a section without gaps in its regions
    constexpr double kOfSmallRegion = 12;  // however small it is beside others
    constexpr double kOfWall = 0.4;        // the step, of a wall's mean thickness, so that none falls between two places
    constexpr double kMostSteps = 400;     // along a section
    const SectionAxes axes(section);
    std::vector<Outline> outlines;
    double whole_area = 0, length = 0;
    for (std::size_t o = 0; o < section.outlines.size(); ++o) {
        outlines.push_back(outline_along(axes, section.outlines[o]));
        whole_area += section.layer(o) * outlines.back().area;
        length += perimeter(section.outlines[o]);
    }
    whole_area = std::max(whole_area, 0.0);       // holes may lie beside what they are cut from
    const double wall = 2 * whole_area / length;  // a thin ring's thickness, a disc's radius
    const double least = each_of_many(outlines.size(), kOfSmallRegion);
    const SectionSearch search(section);
    std::vector<Probe> result;
    for (std::size_t o = 0; o < outlines.size(); ++o) {
        if (section.layer(o) < 0) continue;
        const auto& [box, area] = outlines[o];
        const auto& [low, high] = box;
        const double width = high[0] - low[0], height = high[1] - low[1];
        const double step = std::max(std::min({std::sqrt(whole_area / kProbes), std::sqrt(area / least), kOfWall * wall}),
                                     std::max(width, height) / kMostSteps);
        // Symmetric about the middle: the axes' signs mean nothing.
        const auto columns = static_cast<int>(width / 2 / step), rows = static_cast<int>(height / 2 / step);
        for (int row = -rows; row <= rows; ++row)
            for (int column = -columns; column <= columns; ++column) {
                const Point2 at =
                    axes.to_plane({(low[0] + high[0]) / 2 + column * step, (low[1] + high[1]) / 2 + row * step});
                if (!search.contains(at) || !belongs_to(section, search, o, at)) continue;
                if (const double depth = search.clearance(at); depth > step / 2) result.push_back({at, depth, o});
            }
    }
    return result;
}

double deepest(const std::vector<Probe>& inside) {
    double depth = 0;
    for (const Probe& probe : inside) depth = std::max(depth, probe.depth);
    return depth;
}

}  // namespace kontur
