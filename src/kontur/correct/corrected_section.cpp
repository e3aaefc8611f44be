// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/corrected_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "kontur/base/error.h"
#include "kontur/base/smooth_step.h"
#include "kontur/extract/isolines.h"
#include "kontur/shape/apply_fill_rule.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

/// Of a stroke's length: how far its ends may lie from the outline that it corrects.
constexpr double kFarthestEnd = 0.5;
/// Of kRepeats: from there on all of a section counts. By twice instead three axial planes make .9390 for .9398
/// (bench/correct.py).
constexpr double kMoves = 1.5;
/// Of what counts as still: how far a line may lie from the mask's outline within its plane.
constexpr double kMovedInPlane = 4;

BoxCorners corners_of(const Grid& grid) {
    BoxCorners corners;
    for (std::size_t n = 0; n < corners.size(); ++n)
        corners[n] = grid.center_mm(n & 1 ? grid.size.i - 1 : 0, n & 2 ? grid.size.j - 1 : 0, n & 4 ? grid.size.k - 1 : 0);
    return corners;
}

/// The mask's outlines in a plane.
Section outlines_in(const Plane& plane, const ExistingSurface& surface, double step_mm) {
    Section section{plane, {}, {}, {}};
    const auto lattice = lattice_over(plane, corners_of(surface.object_grid()), step_mm);
    if (!lattice) return section;
    std::vector<double> values(static_cast<std::size_t>(lattice->node_count()));
    for (std::int64_t j = 0; j < lattice->rows; ++j)
        for (std::int64_t i = 0; i < lattice->columns; ++i)
            values[static_cast<std::size_t>(i + j * lattice->columns)] = surface.value(plane.from_uv(lattice->uv(i, j)));
    for (Isoline& line : isolines(*lattice, values)) {
        section.outlines.push_back(std::move(line.points));
        section.holes.push_back(line.hole);
        section.contours.push_back(0);
    }
    return section;
}

double apart(const Point2& a, const Point2& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

/// The outline's points after one place up to another, in its direction.
Polygon2 points_between(const Polygon2& outline, const Section::Nearest& from, const Section::Nearest& to) {
    const Point2& end = outline[from.end];
    const bool is_ahead = from.end == to.end && apart(end, to.position) <= apart(end, from.position);
    Polygon2 points;
    if (is_ahead) return points;
    for (std::size_t n = from.end;; n = (n + 1) % outline.size()) {
        if (n == to.end && !points.empty()) return points;
        points.push_back(outline[n]);
    }
}

double length_along(const Point2& from, const Polygon2& between, const Point2& to) {
    double length = 0;
    Point2 last = from;
    for (const Point2& p : between) length += apart(last, p), last = p;
    return length + apart(last, to);
}

/// The outline with the shorter piece between two places replaced by a line from the one to the other.
Polygon2 with_piece(const Polygon2& outline, const Section::Nearest& from, const Section::Nearest& to, Polygon2 line) {
    const Polygon2 ahead = points_between(outline, from, to), behind = points_between(outline, to, from);
    const bool keep_behind =
        length_along(from.position, ahead, to.position) <= length_along(to.position, behind, from.position);
    if (!keep_behind) std::reverse(line.begin(), line.end());
    const Polygon2& kept = keep_behind ? behind : ahead;
    line.insert(line.end(), kept.begin(), kept.end());
    return line;
}

[[noreturn]] void refuse(std::size_t contour, const std::string& why) {
    throw Error(ErrorKind::invalid_input, fmt::format("contour {} {}", contour + 1, why));
}

/// Replaces a piece of the section's outline by an open contour.
void replace_piece(CorrectedSection& section, const Contour& stroke, std::size_t number) {
    Polygon2 line;
    for (const Vec3& p : stroke.points) line.push_back(section.plane.to_uv(p));
    if (section.after.outlines.empty())
        refuse(number, "is open, and the mask has no outline in its plane of which it could replace a piece; close it");
    const Section::Nearest from = section.after.nearest(line.front()), to = section.after.nearest(line.back());
    if (from.outline != to.outline)
        refuse(number, "is open and ends at two outlines of the mask; draw the whole outline as a closed contour");
    const double length = line_length(stroke.points, false), farthest = std::max(from.distance, to.distance);
    if (farthest > kFarthestEnd * length)
        refuse(number, fmt::format("is open, and an end of it lies {:.1f} mm from the mask's outline, more than half of "
                                   "its length of {:.1f} mm; draw it up to the outline, or close it",
                                   farthest, length));
    Polygon2& outline = section.after.outlines[from.outline];
    outline = with_piece(outline, from, to, std::move(line));
}

/// Tells what is wrong with single contours; what is wrong with a set does not matter beside a mask.
void check_drawing(const ContourSet& drawing) {
    for (std::size_t n = 0; n < drawing.contours.size(); ++n)
        if (const auto problem = contour_problem(drawing.contours[n], fmt::format("contour {}", n + 1)))
            throw Error(ErrorKind::invalid_input, *problem);
    for (const std::vector<Vec3>* points : {&drawing.interior, &drawing.exterior})
        for (const Vec3& p : *points)
            if (!is_finite(p))
                throw Error(ErrorKind::invalid_input, "an interior or exterior point has a coordinate that is no number");
}

CorrectedSection whole_section(Section after, const ExistingSurface& surface, const ContourSet& closed,
                               const std::vector<std::size_t>& numbers, double step_mm) {
    CorrectedSection section{after.plane, outlines_in(after.plane, surface, step_mm), std::move(after)};
    for (std::size_t o = 0; o < section.after.outlines.size(); ++o) {
        const std::size_t contour = section.after.contours[o];
        section.lines.push_back({section.after.outlines[o], true, closed.contours[contour].weight});
        section.contours.push_back(numbers[contour]);
    }
    return section;
}

/// The largest distance of lines from outlines, and of these from the lines'.
double farthest_apart(const Section& before, const Section& after) {
    const auto farthest = [](const Section& from, const SectionSearch& to) {
        double most = 0;
        for (const Polygon2& outline : from.outlines)
            for (const Point2& p : outline) most = std::max(most, to.clearance(p));
        return most;
    };
    if (before.outlines.empty() || after.outlines.empty()) return std::numeric_limits<double>::infinity();
    return std::max(farthest(before, SectionSearch(after)), farthest(after, SectionSearch(before)));
}

/// The largest voxel side along a plane: how well a mask's outline is known there.
double coarseness_mm(const Plane& plane, const Grid& grid) {
    double most = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 side = grid.index_to_mm.column(axis);
        most = std::max(most, norm(side - dot(side, plane.normal) * plane.normal));
    }
    return most;
}

double moved_share(const CorrectedSection& section, const Grid& grid) {
    const double least = kRepeats * coarseness_mm(section.plane, grid), most = kMoves * least;
    if (section.largest_move_mm >= most) return 1;
    const double in_plane = farthest_apart(section.before, section.after) / kMovedInPlane;
    return smooth_step(least, most, std::max(section.largest_move_mm, in_plane));
}

double largest_move_mm(const CorrectedSection& section, const ExistingSurface& surface) {
    double largest = 0;
    for (const DrawnLine& line : section.lines)
        for (const Point2& p : line.points) largest = std::max(largest, std::abs(surface.value(section.plane.from_uv(p))));
    return largest;
}

}  // namespace

bool CorrectedSection::moves(double still_mm) const {
    if (largest_move_mm > still_mm || before.outlines.size() != after.outlines.size()) return true;
    // In a mask of one slice all is near to the surface: what moves there moves within the plane.
    const SectionSearch old(before);
    return std::any_of(lines.begin(), lines.end(), [&](const DrawnLine& line) {
        return std::any_of(line.points.begin(), line.points.end(),
                           [&](const Point2& p) { return old.clearance(p) > kMovedInPlane * still_mm; });
    });
}

std::vector<CorrectedSection> corrected_sections(const ExistingSurface& surface, const Corrections& corrections,
                                                 double step_mm) {
    const ContourSet& drawing = corrections.drawing;
    check_drawing(drawing);
    ContourSet closed;
    std::vector<std::size_t> numbers;
    for (std::size_t n = 0; n < drawing.contours.size(); ++n)
        if (drawing.contours[n].closed) {
            closed.contours.push_back(drawing.contours[n]);
            numbers.push_back(n);
        }
    std::vector<CorrectedSection> sections;
    const double tolerance = kSamePlane * 2 * surface.radius_mm();
    if (!closed.contours.empty()) {
        apply_fill_rule(closed, FillRule::even_odd);
        for (Section& section : sections_of(closed, tolerance))
            sections.push_back(whole_section(std::move(section), surface, closed, numbers, step_mm));
    }
    for (std::size_t n = 0; n < drawing.contours.size(); ++n) {
        const Contour& stroke = drawing.contours[n];
        if (stroke.closed) continue;
        auto at = std::find_if(sections.begin(), sections.end(),
                               [&](const CorrectedSection& section) { return lies_in(stroke, section.plane, tolerance); });
        if (at == sections.end()) {
            const Section before = outlines_in(stroke.plane, surface, step_mm);
            sections.push_back({.plane = stroke.plane, .before = before, .after = before, .redrawn = false});
            at = sections.end() - 1;
        }
        replace_piece(*at, stroke, n);
        at->contours.push_back(n);
        at->lines.clear();
        for (const Polygon2& outline : at->after.outlines) at->lines.push_back({outline, true, stroke.weight});
    }
    for (CorrectedSection& section : sections) {
        section.largest_move_mm = largest_move_mm(section, surface);
        if (section.redrawn) section.moved_share = moved_share(section, surface.grid());
    }
    for (const Plane& plane : drawing.empty_planes)
        sections.push_back({.plane = plane, .before = outlines_in(plane, surface, step_mm), .after = {plane, {}, {}, {}}});
    for (const Plane& plane : corrections.confirmed) {
        const Section before = outlines_in(plane, surface, step_mm);
        sections.push_back({.plane = plane, .before = before, .after = before});
        for (const Polygon2& outline : before.outlines) sections.back().lines.push_back({outline, true, 1});
    }
    return sections;
}

}  // namespace kontur
