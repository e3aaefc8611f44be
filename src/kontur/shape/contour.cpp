// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/contour.h"

#include <fmt/format.h>

#include <algorithm>

#include "kontur/base/checks.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/shape/grid.h"

namespace kontur {
namespace {

// In mm from the origin: what lies farther away is no drawing, and its cube may have no double.
constexpr double kFarthestCoordinate = 1e9;

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::invalid_input, message); }

void check_finite(const Vec3& point, std::size_t number, const std::string& owner) {
    if (!is_finite(point)) refuse(fmt::format("point {} of {} has a NaN or infinite coordinate", number, owner));
    for (const double coordinate : {point.x, point.y, point.z})
        if (std::abs(coordinate) > kFarthestCoordinate)
            refuse(fmt::format("point {} of {} has the coordinate {:g} mm; the limit is {:g} mm", number, owner, coordinate,
                               kFarthestCoordinate));
}

void check_all_finite(const std::vector<Vec3>& points, const std::string& owner) {
    for (std::size_t i = 0; i < points.size(); ++i) check_finite(points[i], i + 1, owner);
}

bool is_unit(const Vec3& direction) {
    // Six decimals are common in files, and readers restore the unit length.
    constexpr double kUnitTolerance = 1e-5;
    return std::abs(norm(direction) - 1) <= kUnitTolerance;
}

void check_plane(const Plane& plane, const std::string& name) {
    if (!is_finite(plane.origin) || !is_unit(plane.normal))
        refuse(fmt::format("{} has an origin that is not finite or a normal that is not of length 1", name));
}

void check_on_plane(const Contour& contour, double limit_mm, const std::string& owner) {
    const auto off_plane = [&](const Vec3& p) { return std::abs(contour.plane.distance_to(p)); };
    const auto worst = std::max_element(contour.points.begin(), contour.points.end(),
                                        [&](const Vec3& a, const Vec3& b) { return off_plane(a) < off_plane(b); });
    if (!(off_plane(*worst) <= limit_mm))
        refuse(fmt::format("point {} of {} lies {:.6g} mm off its plane; the limit is {:g} mm",
                           worst - contour.points.begin() + 1, owner, off_plane(*worst), limit_mm));
}

Vec3 farthest_from(const Vec3& from, const std::vector<Vec3>& points) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vec3& a, const Vec3& b) { return distance(from, a) < distance(from, b); });
}

/// Files round to absolute lengths; beside a contour of a micrometre they are no small ones.
double line_limit_mm(const Contour& contour, const ContourCheckOptions& options) {
    return std::min(options.line_tolerance_mm, 1e-3 * bounding_box(contour.points).diagonal());
}

bool lacks_area(const Contour& contour, const ContourCheckOptions& options) {
    return contour.closed && !(width_mm(contour.points) > line_limit_mm(contour, options));
}

std::string lack_of_area(const Contour& contour, const ContourCheckOptions& options, const std::string& owner) {
    return fmt::format("{} has no area: its {} points lie within {:.2g} mm of one line; the limit is {:g} mm", owner,
                       contour.points.size(), width_mm(contour.points), line_limit_mm(contour, options));
}

void check_area(const Contour& contour, const ContourCheckOptions& options, const std::string& owner) {
    if (lacks_area(contour, options)) refuse(lack_of_area(contour, options, owner));
}

void check_meaning(const Contour& contour, const std::string& owner) {
    if (!contour.closed && contour.hole) refuse(owner + " is open and a hole; only closed contours can be holes");
    if (!contour.closed && contour.end != ContourEnd::automatic)
        refuse(owner + " is open and ends the object; only closed contours can");
    if (contour.hole && contour.end != ContourEnd::automatic)
        refuse(owner + " is a hole and ends the object; only an outer contour can");
    if (contour.closed && contour.inside)
        refuse(owner + " is closed and says on which hand the object lies; only open contours need that");
    if (!(contour.weight >= kLeastWeight && contour.weight <= kMostWeight))
        refuse(fmt::format("{} has the weight {:g}; it must be from {:g} to {:g}", owner, contour.weight, kLeastWeight,
                           kMostWeight));
    if (contour.frame && contour.time_s) refuse(owner + " has a frame and a time; one of them tells when it was drawn");
    if (contour.frame && !(std::isfinite(*contour.frame) && *contour.frame >= 1))
        refuse(fmt::format("{} was drawn in frame {:g}; frames count from 1", owner, *contour.frame));
    if (contour.time_s && !std::isfinite(*contour.time_s))
        refuse(fmt::format("{} was drawn at {:g} s, which is no time", owner, *contour.time_s));
}

std::string moment_of(const Contour& contour) {
    if (contour.frame) return fmt::format("in frame {:g}", *contour.frame);
    return contour.time_s ? fmt::format("at {:g} s", *contour.time_s) : "at no moment in particular";
}

void check_contour(const Contour& contour, const ContourCheckOptions& options, const std::string& owner) {
    const std::size_t least = contour.closed ? 3 : 2;
    if (contour.points.size() < least)
        refuse(fmt::format("{} has {}; at least {} are needed", owner, counted(contour.points.size(), "point"), least));
    check_all_finite(contour.points, owner);
    check_plane(contour.plane, "the plane of " + owner);
    check_on_plane(contour, std::min(options.plane_tolerance_mm, 0.1 * bounding_box(contour.points).diagonal()), owner);
    check_meaning(contour, owner);
}

/// Some contour must have the object on its inside.
void check_encloses(const std::vector<Contour>& contours) {
    if (contours.empty()) refuse("there is no contour; at least 1 is needed");
    if (std::all_of(contours.begin(), contours.end(), [](const Contour& contour) { return contour.hole; }))
        refuse(fmt::format("all contours are holes ({}); at least 1 must be none", contours.size()));
}

/// A surface point farther away would make lengths that follow from the extent larger than the contours themselves, an
/// interior one the unit of length.
void check_near(const Vec3& point, std::string_view kind, std::size_t number, const Box3& contours) {
    check_finite(point, number, fmt::format("the {} points", kind));
    const double away = distance(point, contours.center()), size = contours.diagonal();
    if (away > kFarthestSurfacePoint * size)
        refuse(fmt::format("{} point {} lies {:.3g} mm from the contours, {:.3g} times their size; the limit is {:g} times",
                           kind, number, away, away / size, kFarthestSurfacePoint));
}

void check_surface_point(const SurfacePoint& point, std::size_t number, const Box3& contours) {
    check_near(point.position, "surface", number, contours);
    if (point.outward && !is_unit(*point.outward))
        refuse(
            fmt::format("the outward direction of surface point {} has length {:g}, not 1", number, norm(*point.outward)));
}

/// The sentence with which a check refuses.
template <class Check>
std::optional<std::string> refusal(const Check& check) {
    try {
        check();
        return std::nullopt;
    } catch (const Error& error) {
        return error.what();
    }
}

/// Some contour shows the object though closed ones without area are left out.
bool shows_without_lines(const ContourSet& set, const ContourCheckOptions& options) {
    return std::any_of(set.contours.begin(), set.contours.end(),
                       [&](const Contour& contour) { return !contour.hole && !lacks_area(contour, options); });
}

bool is_inside(const Grid& grid, const Vec3& index) {
    constexpr double kSlack = 1e-6;  // voxels; a point on the outer face may be rounded to either side
    for (int axis = 0; axis < 3; ++axis) {
        const double last_face = static_cast<double>(grid.size[axis]) - 0.5;
        if (!(index[axis] >= -0.5 - kSlack && index[axis] <= last_face + kSlack)) return false;
    }
    return true;
}

/// Whether the box around the contours' points, along the grid's axes, reaches into the grid's voxels.
bool overlaps(const Grid& grid, const ContourSet& set) {
    const Affine3 mm_to_index = grid.index_to_mm.inverse();
    Box3 box;
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) box.extend(mm_to_index.apply(p));
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.max[axis] >= -0.5 && box.min[axis] <= static_cast<double>(grid.size[axis]) - 0.5)) return false;
    return true;
}

}  // namespace

std::string_view name(ContourEnd end) noexcept {
    switch (end) {
        case ContourEnd::automatic:
            return "automatic";
        case ContourEnd::flat:
            return "flat";
        case ContourEnd::round:
            return "round";
    }
    return "?";
}

std::string_view name(Hand hand) noexcept { return hand == Hand::left ? "left" : "right"; }

std::size_t point_count(const ContourSet& set) {
    std::size_t count = 0;
    for (const Contour& contour : set.contours) count += contour.points.size();
    return count;
}

Box3 bounding_box(const ContourSet& set) {
    Box3 box;
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) box.extend(p);
    for (const SurfacePoint& p : set.surface) box.extend(p.position);
    return box;
}

Ball3 smallest_ball(const ContourSet& set) {
    std::vector<Vec3> points;
    points.reserve(point_count(set) + set.surface.size());
    for (const Contour& contour : set.contours) points.insert(points.end(), contour.points.begin(), contour.points.end());
    for (const SurfacePoint& p : set.surface) points.push_back(p.position);
    return smallest_ball(points);
}

double diameter_mm(const ContourSet& set) { return smallest_ball(set).diameter(); }

double width_mm(const std::vector<Vec3>& points) {
    if (points.empty()) return 0;
    const Vec3 one_end = farthest_from(points.front(), points);
    const Vec3 axis = normalized(farthest_from(one_end, points) - one_end);
    double widest = 0;
    for (const Vec3& p : points) widest = std::max(widest, norm(cross(p - one_end, axis)));
    return widest;
}

std::size_t drop_duplicate_points(ContourSet& set) {
    const std::size_t before = point_count(set);
    for (Contour& contour : set.contours) {
        std::vector<Vec3>& points = contour.points;
        points.erase(std::unique(points.begin(), points.end()), points.end());
        while (contour.closed && points.size() > 1 && points.back() == points.front()) points.pop_back();
    }
    return before - point_count(set);
}

bool is_moving(const ContourSet& set) {
    return std::any_of(set.contours.begin(), set.contours.end(), [&](const Contour& contour) {
        return contour.frame != set.contours.front().frame || contour.time_s != set.contours.front().time_s;
    });
}

void check_contours(const ContourSet& set, const ContourCheckOptions& options) {
    const std::vector<std::string> problems = contour_problems(set, options);
    if (!problems.empty()) refuse(problems.front());
    if (!is_moving(set)) return;
    std::size_t other = 1;
    while (moment_of(set.contours[other]) == moment_of(set.contours.front()) && other + 1 < set.contours.size()) ++other;
    refuse(
        fmt::format("contour 1 was drawn {} and contour {} {}; only kontur segment with a 4D --image takes several moments",
                    moment_of(set.contours.front()), other + 1, moment_of(set.contours[other])));
}

void check_tolerances(const ContourCheckOptions& options) {
    check_not_below_0("the tolerance for points off their plane", options.plane_tolerance_mm, " mm");
    check_not_below_0("the tolerance for lines", options.line_tolerance_mm, " mm");
}

std::vector<std::string> contour_problems(const ContourSet& set, const ContourCheckOptions& options) {
    check_tolerances(options);
    const bool lines_may_go = shows_without_lines(set, options);
    std::vector<std::string> problems;
    for (std::size_t i = 0; i < set.contours.size(); ++i) {
        const std::string name = fmt::format("contour {}", i + 1);
        const auto problem = refusal([&] {
            check_contour(set.contours[i], options, name);
            if (!lines_may_go) check_area(set.contours[i], options, name);
        });
        if (problem) problems.push_back(*problem);
    }
    const std::vector<std::string> others = set_problems(set);
    problems.insert(problems.end(), others.begin(), others.end());
    return problems;
}

std::optional<std::string> contour_problem(const Contour& contour, const std::string& name,
                                           const ContourCheckOptions& options) {
    return refusal([&] {
        check_contour(contour, options, name);
        check_area(contour, options, name);
    });
}

std::vector<std::string> leave_out_lines(ContourSet& set, const ContourCheckOptions& options) {
    if (!shows_without_lines(set, options)) return {};
    std::string first;
    std::vector<Contour> others;
    for (std::size_t i = 0; i < set.contours.size(); ++i) {
        if (!lacks_area(set.contours[i], options)) others.push_back(std::move(set.contours[i]));
        else if (first.empty()) first = lack_of_area(set.contours[i], options, fmt::format("contour {}", i + 1));
    }
    const std::size_t left_out = set.contours.size() - others.size();
    set.contours = std::move(others);
    if (left_out == 0) return {};
    return {left_out == 1 ? first + "; it was left out, and contours after it count one less"
                          : fmt::format("{}; it and {} more of that kind were left out, and those after them count less",
                                        first, left_out - 1)};
}

std::vector<std::string> set_problems(const ContourSet& set) {
    std::vector<std::string> problems;
    const auto collect = [&](const auto& check) {
        if (const auto problem = refusal(check)) problems.push_back(*problem);
    };
    collect([&] { check_encloses(set.contours); });
    Box3 box;
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) box.extend(p);
    for (std::size_t i = 0; i < set.interior.size(); ++i)
        collect([&] { check_near(set.interior[i], "interior", i + 1, box); });
    collect([&] { check_all_finite(set.exterior, "the exterior points"); });
    for (std::size_t i = 0; i < set.surface.size(); ++i) collect([&] { check_surface_point(set.surface[i], i + 1, box); });
    for (std::size_t i = 0; i < set.empty_planes.size(); ++i)
        collect([&] { check_plane(set.empty_planes[i], fmt::format("empty plane {}", i + 1)); });
    return problems;
}

std::size_t points_outside(const ContourSet& set, const Grid& grid) {
    const Affine3 mm_to_index = grid.index_to_mm.inverse();
    std::size_t count = 0;
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) count += !is_inside(grid, mm_to_index.apply(p));
    return count;
}

std::optional<std::string> check_contours_inside(const ContourSet& set, const Grid& grid) {
    const std::size_t total = point_count(set), outside = points_outside(set, grid);
    if (outside == 0) return std::nullopt;
    if (outside == total && !overlaps(grid, set))
        refuse(
            fmt::format("all {} contour points lie outside of the image; are the contours and the image of one patient "
                        "and in one frame of reference?",
                        total));
    return fmt::format("{} of {} contour points lie outside of the image", outside, total);
}

}  // namespace kontur
