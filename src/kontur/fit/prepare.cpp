// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
#include "kontur/drawing/extents.h"
#include "kontur/drawing/gaps.h"
#include "kontur/drawing/inner_lines.h"
#include "kontur/drawing/orient.h"
#include "kontur/drawing/reduce.h"
#include "kontur/drawing/ring_starts.h"
#include "kontur/drawing/subdivide.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

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

Contour shifted(Contour contour, const Vec3& by) {
    contour.plane.origin += by;
    for (Vec3& p : contour.points) p += by;
    return contour;
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

void append_closed(const Contour& contour, std::int32_t index, const DrawnCorners& corners, PreparedContours& prepared) {
    const ContourOrientation orientation = orient(contour);
    // At a corner the surface has no one direction: its edges' points beside it have theirs.
    const std::vector<bool> is_corner = corners.among(contour);
    for (std::size_t i = 0; i < contour.points.size(); ++i)
        prepared.points.push_back({.position = contour.points[i],
                                   .inplane_normal = is_corner[i] ? Vec3{} : orientation.normals[i],
                                   .plane_normal = contour.plane.normal,
                                   .contour = index,
                                   .trust = contour.weight,
                                   .on_ring = true});
    const auto append_to = [](std::vector<Vec3>& to, const std::vector<Vec3>& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append_to(prepared.crossings, orientation.crossings);
    append_to(prepared.between_crossings, orientation.between_crossings);
}

void append_open(const Contour& contour, std::int32_t index, PreparedContours& prepared) {
    if (!contour.inside)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("contour {} is open and does not tell on which hand the object lies", index + 1));
    const std::vector<Vec3> left = left_normals(contour);
    const double outward = contour.inside == Hand::left ? -1 : 1;
    for (std::size_t i = 0; i < contour.points.size(); ++i)
        prepared.points.push_back({contour.points[i], outward * left[i], contour.plane.normal, index, contour.weight});
}

void append_surface_points(const ContourSet& set, PreparedContours& prepared) {
    for (const SurfacePoint& p : set.surface)
        prepared.points.push_back(
            {.position = p.position, .inplane_normal = p.outward.value_or(Vec3{}), .contour = kNoContour});
}

/// Contours beyond the drawn ones are copies of the first.
void append_boundary(const ContourSet& set, std::size_t drawn, const DrawnCorners& corners, PreparedContours& prepared) {
    const auto index = [&](std::size_t c) { return static_cast<std::int32_t>(c < drawn ? c : 0); };
    for (std::size_t c = 0; c < set.contours.size(); ++c)
        if (set.contours[c].closed) append_closed(set.contours[c], index(c), corners, prepared);
    append_surface_points(set, prepared);
    for (std::size_t c = 0; c < set.contours.size(); ++c)
        if (!set.contours[c].closed) append_open(set.contours[c], index(c), prepared);
}

void append_limits(const DrawnPlanes& planes, const PrepareOptions& options, const Work& work, PreparedContours& prepared) {
    if (options.bounds) {
        Bounds limits = find_bounds(planes, work);
        prepared.bounds = std::move(limits.bounds);
        if (!prepared.coplanar) prepared.notes.insert(prepared.notes.end(), limits.notes.begin(), limits.notes.end());
        const Ends ends = find_ends(planes);
        prepared.points.insert(prepared.points.end(), ends.lids.begin(), ends.lids.end());
        prepared.bounds.insert(prepared.bounds.end(), ends.guards.begin(), ends.guards.end());
        prepared.notes.insert(prepared.notes.end(), ends.notes.begin(), ends.notes.end());
        const std::vector<Bound> far = far_bounds(planes);
        prepared.bounds.insert(prepared.bounds.end(), far.begin(), far.end());
        const std::vector<std::string> contradicted = contradicted_empty_planes(planes);
        prepared.notes.insert(prepared.notes.end(), contradicted.begin(), contradicted.end());
    }
    const std::vector<Bound> clicks = click_bounds(planes.set, options.click_margin_mm);
    prepared.bounds.insert(prepared.bounds.end(), clicks.begin(), clicks.end());
    const std::vector<std::string> doubts = contradictory_clicks(planes, options.click_margin_mm);
    prepared.notes.insert(prepared.notes.end(), doubts.begin(), doubts.end());
}

/// What lies far away, at the edge of all, keeps the extent of all.
void find_extents(const Extents& extents, const Work& work, PreparedContours& prepared) {
    if (extents.is_one_part()) return;
    const auto find = [&](auto& places) {
        parallel_for(static_cast<std::int64_t>(places.size()), 256, work, [&](std::int64_t begin, std::int64_t end) {
            for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
                places[i].extent = extents.at(places[i].position);
        });
    };
    find(prepared.points);
    find(prepared.bounds);
}

/// Of one contour among so many: each of them gets fewer where they are very many, so that they share what can be solved.
int least_segments(const PrepareOptions& options, std::size_t contours) {
    constexpr std::size_t kAllContours = 4800;
    constexpr int kLeast = 12;
    const auto share = std::max(kLeast, static_cast<int>(kAllContours / std::max<std::size_t>(contours, 1)));
    return static_cast<int>(std::ceil(options.quality * std::min(options.least_segments, share)));
}

/// How finely lines are followed where they are narrow, and around the ends of thin parts.
FinePieces fine_pieces(const ContourSet& set, int least_segments, double diameter_mm) {
    constexpr int kFiner = 8;        // than elsewhere, at most
    constexpr double kBulge = 0.01;  // of the diameter; normal constraints lie 1.35 % of it beside the line
    FinePieces pieces{{}, {}, kBulge * diameter_mm};
    for (const Contour& contour : set.contours) {
        pieces.long_mm.push_back(line_length(contour.points, contour.closed) / least_segments);
        pieces.shortest_mm.push_back(pieces.long_mm.back() / kFiner);
    }
    return pieces;
}

Contour subdivided(const Contour& contour, int least_segments, const DrawnCorners& corners, const PrepareOptions& options) {
    if (options.corners == Corners::rounded || !contour.closed) return subdivide(contour, least_segments);
    return subdivide_to_corners(contour, corners.among(contour), options.corner_spacing_mm,
                                line_length(contour.points, contour.closed) / std::max(least_segments, 1));
}

void check_prepare_options(const PrepareOptions& options) {
    check_quality(options.quality);
    check_at_least("the least number of segments", options.least_segments, 0);
    check_not_below_0("the shift of the copy", options.copy_shift_mm, " mm");
    check_above_0("the margin of interior and exterior points", options.click_margin_mm, " mm");
    check_above_0("the spacing at corners", options.corner_spacing_mm, " mm");
}

}  // namespace

PreparedContours prepare(const Drawing& drawing, const PrepareOptions& options, const Work& work) {
    check_prepare_options(options);
    PreparedContours prepared;
    const double diameter = drawing.diameter_mm();
    ContourSet set = drawing.tidied;
    if (options.least_segments > 0)  // the paper's rules go by the order of drawing
        for (Contour& contour : set.contours) begin_alike(contour, drawing.ball);
    const DrawnPlanes planes(set, drawing.ball);
    prepared.ball = drawing.ball;
    const Extents extents(set, drawing.ball);
    prepared.coplanar = is_coplanar(planes, extents);

    ContourSet reduced = set;
    const DrawnCorners corners(set, options.corners);
    for (Contour& contour : reduced.contours) contour = reduce(contour, {options.quality});
    ContourSet fitted = reduced;
    const int least = least_segments(options, set.contours.size());
    for (Contour& contour : fitted.contours) contour = subdivided(contour, least, corners, options);
    if (least > 0) subdivide_narrow(reduced, fitted, fine_pieces(reduced, least, diameter), kSamePlane * diameter, work);
    if (prepared.coplanar && options.copy_shift_mm > 0) {
        const Contour& first = fitted.contours.front();
        fitted.contours.push_back(shifted(first, options.copy_shift_mm * first.plane.normal));
    }
    append_boundary(fitted, set.contours.size(), corners, prepared);
    if (options.bounds)  // by the sections of the lines that the points lie on: chords of fewer points run within the drawn
                         // ones
        leave_out_inner_lines(options.quality < 1 ? DrawnPlanes(reduced, drawing.ball) : planes, planes.tolerance_mm,
                              prepared.points);
    if (options.gaps) find_gaps(fitted, 0.15 * diameter, kSamePlane * diameter, prepared.points, work);
    append_limits(planes, options, work, prepared);
    find_extents(extents, work, prepared);
    return prepared;
}

}  // namespace kontur
