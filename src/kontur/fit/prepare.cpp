// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/bounds/clicks.h"
#include "kontur/bounds/empty_planes.h"
#include "kontur/bounds/ends.h"
#include "kontur/bounds/far_bounds.h"
#include "kontur/drawing/drawn_planes.h"
#include "kontur/drawing/each_of_many.h"
#include "kontur/drawing/extents.h"
#include "kontur/drawing/inner_lines.h"
#include "kontur/drawing/opposite_walls.h"
#include "kontur/drawing/orient.h"
#include "kontur/drawing/points_on_edges.h"
#include "kontur/drawing/reduce.h"
#include "kontur/drawing/ring_starts.h"
#include "kontur/drawing/subdivide.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

// Of the drawing's diameter.
constexpr double kBulge = 0.01;  // a curve stands out from an edge; normal constraints lie 1.35 % of it beside the line
// How far opposite walls are looked for. Not at all: a wedge of three clicks falls from .992 to .986, 81 drawings and 30
// solids do not tell.
constexpr double kGapReach = 0.15;

bool is_coplanar(const DrawnPlanes& planes, const Extents& extents) {
    const Plane& plane = planes.set.contours.front().plane;
    const auto off_plane = [&](const Vec3& p) {
        return std::abs(plane.distance_to(p)) > planes.tolerance_mm * extents.at(p);
    };
    for (const Contour& contour : planes.set.contours)
        if (std::any_of(contour.points.begin(), contour.points.end(), off_plane)) return false;
    return std::none_of(planes.set.surface.begin(), planes.set.surface.end(),
                        [&](const SurfacePoint& p) { return off_plane(p.position); });
}

/// A copy, across its plane.
PreparedLine shifted(PreparedLine line, double shift_mm) {
    const Vec3 by = shift_mm * line.fitted.plane.normal;
    line.fitted.plane.origin += by;
    for (Vec3& p : line.fitted.points) p += by;
    return line;
}

/// The corners of all contours as they were drawn; reducing them makes others.
class DrawnCorners {
public:
    DrawnCorners(const ContourSet& set, Corners corners) {
        if (corners == Corners::rounded) return;
        for (const Contour& contour : set.contours) {
            const std::vector<bool> is_corner = find_corners(contour);
            for (std::size_t i = 0; i < is_corner.size(); ++i)
                if (is_corner[i]) points_.push_back(contour.points[i]);
        }
        std::sort(points_.begin(), points_.end(), comes_before);
    }

    /// For each point of a contour whether it is one of them.
    std::vector<bool> among(const Contour& contour) const {
        std::vector<bool> is_corner(contour.points.size(), false);
        if (contour.closed)
            std::transform(contour.points.begin(), contour.points.end(), is_corner.begin(), [&](const Vec3& p) {
                return std::binary_search(points_.begin(), points_.end(), p, comes_before);
            });
        return is_corner;
    }

private:
    static bool comes_before(const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

    std::vector<Vec3> points_;
};

void append_closed(const PreparedLine& line, const DrawnCorners& corners, PreparedContours& prepared) {
    const Contour& contour = line.fitted;
    const ContourOrientation orientation = orient(contour);
    // At a corner the surface has no one direction: its edges' points beside it have theirs.
    const std::vector<bool> is_corner = corners.among(contour);
    for (std::size_t i = 0; i < contour.points.size(); ++i)
        prepared.points.push_back({.position = contour.points[i],
                                   .inplane_normal = is_corner[i] ? Vec3{} : orientation.normals[i],
                                   .plane_normal = contour.plane.normal,
                                   .contour = line.number,
                                   .trust = contour.weight,
                                   .on_ring = true});
    const auto append_to = [](std::vector<Vec3>& to, const std::vector<Vec3>& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append_to(prepared.crossings, orientation.crossings);
    append_to(prepared.between_crossings, orientation.between_crossings);
}

void append_open(const PreparedLine& line, PreparedContours& prepared) {
    const Contour& contour = line.fitted;
    if (!contour.inside)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("contour {} is open and does not tell on which hand the object lies", line.number + 1));
    const std::vector<Vec3> left = left_normals(contour);
    const double outward = contour.inside == Hand::left ? -1 : 1;
    for (std::size_t i = 0; i < contour.points.size(); ++i)
        prepared.points.push_back({contour.points[i], outward * left[i], contour.plane.normal, line.number, contour.weight});
}

void append_surface_points(const ContourSet& set, PreparedContours& prepared) {
    for (const SurfacePoint& p : set.surface)
        prepared.points.push_back(
            {.position = p.position, .inplane_normal = p.outward.value_or(Vec3{}), .contour = kNoContour});
}

void append_boundary(std::span<const PreparedLine> lines, const ContourSet& set, const DrawnCorners& corners,
                     PreparedContours& prepared) {
    for (const PreparedLine& line : lines)
        if (line.fitted.closed) append_closed(line, corners, prepared);
    append_surface_points(set, prepared);
    for (const PreparedLine& line : lines)
        if (!line.fitted.closed) append_open(line, prepared);
}

template <class T>
void append(const std::vector<T>& from, std::vector<T>& to) {
    to.insert(to.end(), from.begin(), from.end());
}

void append_limits_of_planes(const DrawnPlanes& planes, const Work& work, PreparedContours& prepared) {
    const Bounds limits = find_bounds(planes, work);
    append(limits.bounds, prepared.bounds);
    if (!prepared.coplanar) append(limits.notes, prepared.notes);
    const Ends ends = find_ends(planes);
    append(ends.lids, prepared.points);
    append(ends.guards, prepared.bounds);
    append(ends.notes, prepared.notes);
}

/// For each single point the part of the contour whose points are nearest.
template <class Points, class Position>
std::vector<std::size_t> nearest_parts(const ContourSet& set, const std::vector<std::size_t>& part_of, const Points& points,
                                       const Position& position) {
    std::vector<std::size_t> parts(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < set.contours.size(); ++c)
            for (const Vec3& p : set.contours[c].points)
                if (const double apart = distance(p, position(points[i])); apart < nearest) {
                    nearest = apart;
                    parts[i] = part_of[c];
                }
    }
    return parts;
}

/// What the planes of each part say, as if it was drawn alone. Contours keep their numbers: those of other parts have no
/// points.
void append_limits_of_parts(const DrawnPlanes& planes, const Extents& extents, const Work& work,
                            PreparedContours& prepared) {
    const ContourSet& set = planes.set;
    std::vector<std::size_t> part_of(set.contours.size());
    for (std::size_t p = 0; p < extents.parts().size(); ++p)
        for (const std::size_t c : extents.parts()[p]) part_of[c] = p;
    const auto itself = [](const Vec3& p) { return p; };
    const std::vector<std::size_t> surface =
        nearest_parts(set, part_of, set.surface, [](const SurfacePoint& p) { return p.position; });
    const std::vector<std::size_t> interior = nearest_parts(set, part_of, set.interior, itself);
    ContourSet part = set;
    for (Contour& contour : part.contours) {
        contour.points.clear();
        contour.closed = false;
    }
    for (std::size_t p = 0; p < extents.parts().size(); ++p) {
        for (const std::size_t c : extents.parts()[p]) part.contours[c] = set.contours[c];
        part.surface.clear();
        part.interior.clear();
        for (std::size_t i = 0; i < surface.size(); ++i)
            if (surface[i] == p) part.surface.push_back(set.surface[i]);
        for (std::size_t i = 0; i < interior.size(); ++i)
            if (interior[i] == p) part.interior.push_back(set.interior[i]);
        DrawnPlanes part_planes(part);
        part_planes.image = planes.image;
        append_limits_of_planes(part_planes, work, prepared);
        for (const std::size_t c : extents.parts()[p]) {
            part.contours[c].points.clear();
            part.contours[c].closed = false;
        }
    }
}

void append_limits(const DrawnPlanes& planes, const Extents& extents, const PrepareOptions& options, const Work& work,
                   PreparedContours& prepared) {
    if (options.bounds) {
        if (extents.parts().size() < 2) append_limits_of_planes(planes, work, prepared);
        else append_limits_of_parts(planes, extents, work, prepared);
        append(far_bounds(planes), prepared.bounds);
        const std::vector<std::string> contradicted = contradicted_empty_planes(planes);
        prepared.notes.insert(prepared.notes.end(), contradicted.begin(), contradicted.end());
    }
    const std::vector<Bound> clicks = click_bounds(planes.set, *options.click_margin_mm);
    prepared.bounds.insert(prepared.bounds.end(), clicks.begin(), clicks.end());
    const std::vector<std::string> doubts = contradictory_clicks(planes, *options.click_margin_mm);
    prepared.notes.insert(prepared.notes.end(), doubts.begin(), doubts.end());
}

/// What lies far away, at the edge of all, keeps the extent of all.
template <class Places>
void find_extents(const Extents& extents, const Work& work, Places& places) {
    if (extents.is_one_part()) return;
    parallel_for(static_cast<std::int64_t>(places.size()), 256, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            places[i].extent = extents.at(places[i].position);
    });
}

/// Of one contour among so many: each of them gets fewer where they are very many, so that they share what can be solved.
int least_segments(const PrepareOptions& options, std::size_t contours) {
    return static_cast<int>(std::ceil(options.quality * std::floor(each_of_many(contours, options.least_segments))));
}

Contour subdivided(const Contour& contour, int least_segments, const DrawnCorners& corners, const PrepareOptions& options) {
    if (options.corners == Corners::rounded || !contour.closed) return subdivide(contour, least_segments);
    return subdivide_to_corners(contour, corners.among(contour), *options.corner_spacing_mm,
                                line_length(contour.points, contour.closed) / std::max(least_segments, 1));
}

/// The contours reduced and subdivided, each for itself; of the points that were `drawn` the asked share stays.
std::vector<PreparedLine> lines_of(const ContourSet& set, const ContourSet& drawn, const DrawnCorners& corners,
                                   const PrepareOptions& options) {
    // Than elsewhere, at most, where lines are narrow. Without, an L of 60 x 3 mm by its corners falls from .98 to .95.
    constexpr int kFiner = 8;
    const int least = least_segments(options, set.contours.size());
    std::vector<PreparedLine> lines;
    for (const Contour& contour : set.contours) {
        const auto wanted = options.quality * static_cast<double>(drawn.contours[lines.size()].points.size());
        const double quality = std::min(1.0, wanted / static_cast<double>(std::max<std::size_t>(contour.points.size(), 1)));
        PreparedLine line{static_cast<std::int32_t>(lines.size()), reduce(contour, {quality}), {}};
        line.fitted = subdivided(line.reduced, least, corners, options);
        line.long_mm = line_length(line.reduced.points, line.reduced.closed) / std::max(least, 1);
        line.shortest_mm = line.long_mm / kFiner;
        lines.push_back(std::move(line));
    }
    return lines;
}

/// The sections of the lines that the points lie on: chords of fewer points run within the drawn ones.
void leave_out_inner_lines(std::span<const PreparedLine> lines, const DrawnPlanes& planes, const PrepareOptions& options,
                           std::vector<BoundaryPoint>& points) {
    if (options.quality == 1) return leave_out_inner_lines(planes, planes.tolerance_mm, points);
    ContourSet reduced = planes.set;
    for (const PreparedLine& line : lines) reduced.contours[static_cast<std::size_t>(line.number)] = line.reduced;
    DrawnPlanes planes_of_reduced(reduced, planes.ball);
    planes_of_reduced.image = planes.image;
    leave_out_inner_lines(planes_of_reduced, planes.tolerance_mm, points);
}

/// Of the diameter: so near to an edge a point says nothing of its own.
constexpr double kOnEdge = 1e-6;

/// On the image, if they are.
DrawnPlanes planes_of(const ContourSet& set, const Drawing& drawing, const PrepareOptions& options) {
    DrawnPlanes planes(set, drawing.ball);
    planes.image = image_of(set, options.image);
    return planes;
}

void check_prepare_options(const PrepareOptions& options) {
    check_quality(options.quality);
    check_at_least("the least number of segments", options.least_segments, 0);
    check_not_below_0("the shift of the copy", options.copy_shift_mm, " mm");
    check_above_0("the margin of interior and exterior points", *options.click_margin_mm, " mm");
    check_above_0("the spacing at corners", *options.corner_spacing_mm, " mm");
}

}  // namespace

PrepareOptions resolved(PrepareOptions options, double diameter_mm) {
    options.click_margin_mm = options.click_margin_mm.value_or(kMarginFraction * diameter_mm);
    options.corner_spacing_mm = options.corner_spacing_mm.value_or(2 * kMergeFraction * diameter_mm);
    options.reconcile.offset_mm = options.reconcile.offset_mm.value_or(kMarginFraction * diameter_mm);
    return options;
}

PreparedContours prepare(const Drawing& drawing, const PrepareOptions& given, const Work& work) {
    const double diameter = drawing.diameter_mm();
    const PrepareOptions options = resolved(given, diameter);
    check_prepare_options(options);
    PreparedContours prepared;
    ContourSet set = drawing.tidied;
    if (options.least_segments > 0)  // the paper's rules go by the order of drawing
        for (Contour& contour : set.contours) {
            begin_alike(contour, drawing.ball);
            contour = without_points_on_edges(contour, kOnEdge * diameter);
            begin_alike(contour, drawing.ball);
        }
    const DrawnPlanes planes = planes_of(set, drawing, options);
    prepared.ball = drawing.ball;
    const Extents extents(set, drawing.ball);
    prepared.coplanar = is_coplanar(planes, extents);

    const DrawnCorners corners(set, options.corners);
    std::vector<PreparedLine> lines = lines_of(set, drawing.tidied, corners, options);
    if (options.least_segments > 0) subdivide_narrow(lines, kBulge * diameter, kSamePlane * diameter, work);
    if (prepared.coplanar && options.copy_shift_mm > 0) lines.push_back(shifted(lines.front(), options.copy_shift_mm));
    append_boundary(lines, set, corners, prepared);
    find_extents(extents, work, prepared.points);
    if (options.bounds) leave_out_inner_lines(lines, planes, options, prepared.points);
    if (options.gaps) find_opposite_walls(lines, kGapReach * diameter, kSamePlane * diameter, prepared.points, work);
    append_limits(planes, extents, options, work, prepared);
    find_extents(extents, work, prepared.points);  // those of ends, too
    find_extents(extents, work, prepared.bounds);
    reconcile(prepared.points, drawing.crossings, diameter, options.reconcile);
    return prepared;
}

}  // namespace kontur
