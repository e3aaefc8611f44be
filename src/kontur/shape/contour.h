// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/smallest_ball.h"
#include "kontur/shape/structure_attributes.h"

namespace kontur {

struct Grid;

/// How the object ends at a contour, on the side where no other contour carries it on.
enum class ContourEnd {
    automatic,  ///< it may go on; how far follows from the contours before
    flat,       ///< in the contour's plane
    round,      ///< rounded off close to the contour
};
std::string_view name(ContourEnd end) noexcept;

/// A hand of someone who walks along a contour in drawing order, upright on the side to which the plane's normal points.
enum class Hand { left, right };
std::string_view name(Hand hand) noexcept;

/// One drawn line in a plane: a closed polygon, or an open stretch of the object's boundary. The last point of a closed
/// contour is not a repetition of the first; its orientation carries no meaning.
struct Contour {
    Plane plane;               ///< where it was drawn; the points lie on it within the tolerance of `check_contours`
    std::vector<Vec3> points;  ///< mm, LPS, in drawing order
    bool closed = true;
    bool hole = false;  ///< true: the object lies outside of this contour (a cavity's wall); closed contours only
    ContourEnd end = ContourEnd::automatic;  ///< closed contours only
    std::optional<Hand> inside{};            ///< open contours only: where the object lies; unset: to be found out
    double weight = 1;  ///< how far it is trusted, against smoothness and the contours that it contradicts
    /// When it was drawn, of an object that moves: the image's frame, counted from 1, or seconds. Both unset: of all times.
    std::optional<double> frame{}, time_s{};
};

/// The range of Contour::weight.
inline constexpr double kLeastWeight = 1e-3, kMostWeight = 1e3;

/// A single point on the object's surface.
struct SurfacePoint {
    Vec3 position;                  ///< mm
    std::optional<Vec3> outward{};  ///< unit, out of the object; unset: only the position is known

    friend bool operator==(const SurfacePoint&, const SurfacePoint&) = default;
};

/// Everything the user drew for one object.
struct ContourSet {
    std::string name;  ///< the structure's name; may be empty
    std::vector<Contour> contours;
    std::vector<Vec3> interior;  ///< mm; points that must lie inside the object (Turk & O'Brien's interior constraints)
    std::vector<Vec3> exterior;  ///< mm; points that must lie outside of the object
    std::vector<SurfacePoint> surface{};
    std::vector<Plane> empty_planes{};  ///< that were looked at, and in which nothing of the object is seen
    StructureAttributes attributes{};   ///< what files say of it, carried along
    /// The motion repeats after so many frames or seconds; unset: it does not, or nothing moves.
    std::optional<double> cycle_frames{}, cycle_s{};
};

/// Whether its contours were drawn at different moments.
bool is_moving(const ContourSet& set);

/// Number of points over all contours.
std::size_t point_count(const ContourSet& set);

/// Box of all contour points and single surface points, in mm; empty for an empty set.
Box3 bounding_box(const ContourSet& set);

/// The smallest ball around all contour points and single surface points. Unlike the box, it turns with them.
Ball3 smallest_ball(const ContourSet& set);

/// Diameter of that ball: what the method's lengths are fractions of, so that results turn and scale with the contours.
double diameter_mm(const ContourSet& set);

/// Largest distance in mm of the points from the line through two far ends of them: 0 when all lie on one line.
double width_mm(const std::vector<Vec3>& points);

/// Removes every point that repeats the one before it exactly, and last points that repeat the first of a closed contour.
/// Returns how many were removed. Points of one contour that coincide without being neighbours stay: a contour may touch
/// itself.
std::size_t drop_duplicate_points(ContourSet& set);

/// Beside tiny contours these lengths are less: a tenth of the contour's box diagonal, and a thousandth of it.
struct ContourCheckOptions {
    double plane_tolerance_mm = 0.01;  ///< largest distance of a point from its contour's plane
    double line_tolerance_mm = 0.002;  ///< a contour no wider than this is a line (files round to 0.001 mm)
};

/// Throws Error(invalid_input) for a tolerance below 0 or not finite.
void check_tolerances(const ContourCheckOptions& options);

/// Of the contours' box diagonal: a surface point farther away would make lengths that follow from the extent larger than
/// the contours themselves.
inline constexpr double kFarthestSurfacePoint = 100;

/// Throws Error(invalid_input), naming the contour (counted from 1), the number and the limit, when the set cannot be
/// segmented: no contour, none but holes, a closed contour with fewer than 3 points or an open one with fewer than 2, a NaN
/// or infinite coordinate, a point off its plane by more than the tolerance, `hole` or `end` on an open contour, `inside` on
/// a closed one, `end` on a hole, a weight out of its range, nothing but closed contours whose points lie on one line (zero
/// area) where there are some; beside others such a contour is no reason (leave_out_lines).
/// A frame or a time must be finite, a frame 1 at least, and all contours of one moment, or none of any: what moves is
/// segmented by segment_moving.
/// Interior, exterior and surface points must be finite, outward directions and the normals of empty planes of length 1, and
/// surface points no farther from the contours than `kFarthestSurfacePoint` times the diagonal of their box.
void check_contours(const ContourSet& set, const ContourCheckOptions& options = {});

/// Every reason of `check_contours` to refuse the set but several moments, at most one for each contour; empty when it can
/// be segmented, by segment or segment_moving.
std::vector<std::string> contour_problems(const ContourSet& set, const ContourCheckOptions& options = {});

/// What a contour by itself is to blame for, zero area included; `name` says which it is.
std::optional<std::string> contour_problem(const Contour& contour, const std::string& name,
                                           const ContourCheckOptions& options = {});

/// Those that no single contour is to blame for.
std::vector<std::string> set_problems(const ContourSet& set);

/// Takes closed contours without area, which enclose nothing, out of a set that check_contours accepts with these options.
/// One sentence says how many, and why the first of them, counted as they were before.
std::vector<std::string> leave_out_lines(ContourSet& set, const ContourCheckOptions& options = {});

/// Number of contour points outside of the grid's voxels (their outer faces belong to the grid).
std::size_t points_outside(const ContourSet& set, const Grid& grid);

/// Compares the contours with the image that they claim to be drawn on. Throws Error(invalid_input) when the box around
/// them does not reach into the grid, which mostly means another patient or a mixed-up frame; gives a warning when points
/// lie outside. An image may hold a part of the object between two drawn planes, and no point.
std::optional<std::string> check_contours_inside(const ContourSet& set, const Grid& grid);

}  // namespace kontur
