// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/roi_contours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kontur/base/counted.h"
#include "kontur/io/geometry/keyhole.h"
#include "kontur/io/geometry/shared_planes.h"
#include "kontur/shape/apply_fill_rule.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/fill_rule.h"
#include "kontur/shape/repeated_contours.h"

namespace kontur {
namespace {

/// Channels of keyholes are drawn there and back along the same points, up to the rounding of the file.
constexpr double kChannelToleranceMm = 1e-3;

/// The contours under construction and what is to be told about them.
struct Interpretation {
    InterpretedContours result;
    std::map<std::string, std::size_t> other_types;
    std::size_t without_area = 0;
    std::size_t repeated = 0;
    std::size_t keyholes = 0;
    std::size_t open = 0;
    bool declared_xor = false;
    std::set<std::size_t> in_keyholes;  ///< rings that a file says to be holes, or around such

    void note(const std::string& text) { result.notes.push_back(text); }
};

bool has_area(const std::vector<Vec3>& points) {
    return points.size() >= 3 && width_mm(points) > ContourCheckOptions{}.line_tolerance_mm;
}

void add_ring(Interpretation& interpretation, std::vector<Vec3> ring) {
    if (!has_area(ring)) {
        ++interpretation.without_area;
        return;
    }
    Contour contour;
    contour.points = std::move(ring);
    interpretation.result.contours.push_back(std::move(contour));
}

bool has_length(const std::vector<Vec3>& points) {
    return std::any_of(points.begin(), points.end(), [&](const Vec3& p) { return p != points.front(); });
}

void add_open(Interpretation& interpretation, const StoredContour& stored) {
    if (!has_length(stored.points)) {
        ++interpretation.without_area;
        return;
    }
    Contour contour;
    contour.points = stored.points;
    contour.closed = false;
    interpretation.result.contours.push_back(std::move(contour));
    ++interpretation.open;
}

void add_points(Interpretation& interpretation, const StoredContour& stored) {
    for (const Vec3& p : stored.points) interpretation.result.surface.push_back({p});
}

void add_stored(Interpretation& interpretation, const StoredContour& stored) {
    if (stored.type == "OPEN_PLANAR") return add_open(interpretation, stored);
    if (stored.type == "POINT") return add_points(interpretation, stored);
    const bool exclusive = stored.type == "CLOSEDPLANAR_XOR";
    if (!exclusive && stored.type != "CLOSED_PLANAR") {
        ++interpretation.other_types[stored.type.empty() ? "unknown" : stored.type];
        return;
    }
    interpretation.declared_xor |= exclusive;
    std::vector<std::vector<Vec3>> rings = split_keyhole(stored.points, kChannelToleranceMm);
    interpretation.keyholes += rings.size() > 1;
    if (rings.empty()) ++interpretation.without_area;
    for (std::vector<Vec3>& ring : rings) {
        if (rings.size() > 1) interpretation.in_keyholes.insert(interpretation.result.contours.size());
        add_ring(interpretation, std::move(ring));
    }
}

/// A copy of a contour would cancel it when filled even-odd; nobody means that by storing one twice.
std::size_t count_repeated(const std::vector<StoredContour>& stored, std::vector<bool>& repeated) {
    SeenRings seen(kChannelToleranceMm);
    for (std::size_t n = 0; n < stored.size(); ++n)
        if (stored[n].type == "CLOSED_PLANAR") repeated[n] = !seen.add(stored[n].points);
    return static_cast<std::size_t>(std::count(repeated.begin(), repeated.end(), true));
}

void note_omissions(Interpretation& interpretation) {
    for (const auto& [type, count] : interpretation.other_types)
        interpretation.note(fmt::format("left out {} of type {}", counted(count, "contour"), type));
    if (interpretation.without_area > 0)
        interpretation.note(fmt::format("left out {} without area", counted(interpretation.without_area, "contour")));
    if (interpretation.repeated > 0)
        interpretation.note(fmt::format("left out {} of another contour", counted(interpretation.repeated, "repetition")));
    if (interpretation.keyholes > 0)
        interpretation.note(
            fmt::format("split into outer contours and holes: {}", counted(interpretation.keyholes, "keyhole contour")));
    if (interpretation.open > 0)
        interpretation.note(
            fmt::format("read as stretches of the object's boundary: {}", counted(interpretation.open, "open contour")));
    if (const std::size_t points = interpretation.result.surface.size(); points > 0)
        interpretation.note(fmt::format("read as points on the object's surface: {}", counted(points, "single point")));
}

void note_near_lines(const std::vector<NearLines>& pairs, Interpretation& interpretation) {
    for (const NearLines& pair : pairs)
        interpretation.note(
            pair.is_one
                ? fmt::format("read as one line that was drawn twice, {:.2g} mm apart: contours {} and {}", pair.apart_mm,
                              pair.other + 1, pair.contour + 1)
                : fmt::format("contour {} is read as a hole that leaves a wall of {:.2g} mm within contour {}; where it "
                              "is the same line drawn again, remove one of the two",
                              pair.contour + 1, pair.apart_mm, pair.other + 1));
}

/// Rings of keyholes and of files that declare XOR are what they are declared to be.
void mark_holes(Interpretation& interpretation) {
    ContourSet set;
    set.contours = std::move(interpretation.result.contours);
    const Nesting nesting = find_nesting(set.contours, kChannelToleranceMm);
    for (std::size_t n = 0; n < set.contours.size(); ++n)
        set.contours[n].hole =
            nesting.depth[n] % 2 == 1 && (interpretation.declared_xor || interpretation.in_keyholes.contains(n));
    const FillChanges changes = apply_fill_rule(set, FillRule::even_odd);
    interpretation.result.contours = std::move(set.contours);
    if (interpretation.declared_xor) return;
    const auto holes = std::ranges::count(interpretation.result.contours, true, &Contour::hole);
    if (holes > 0)
        interpretation.note(
            fmt::format("read as holes, filling even-odd: {} inside others on the slice", counted(holes, "contour")));
    note_near_lines(changes.near_lines, interpretation);
    if (!changes.crossings.empty()) interpretation.note(overlap_sentence(changes.crossings));
}

void note_warped(Interpretation& interpretation, double tolerance) {
    std::size_t warped = 0;
    double worst = 0;
    for (const Contour& contour : interpretation.result.contours) {
        double off = 0;
        for (const Vec3& p : contour.points) off = std::max(off, std::abs(contour.plane.distance_to(p)));
        warped += off > tolerance;
        worst = std::max(worst, off);
    }
    if (warped > 0)
        interpretation.note(fmt::format("not planar: {}, with points up to {:.3g} mm off the best plane",
                                        counted(warped, "contour"), worst));
}

}  // namespace

InterpretedContours interpret_contours(const std::vector<StoredContour>& stored) {
    Interpretation interpretation;
    std::vector<bool> repeated(stored.size(), false);
    interpretation.repeated = count_repeated(stored, repeated);
    for (std::size_t n = 0; n < stored.size(); ++n)
        if (!repeated[n]) add_stored(interpretation, stored[n]);
    const double tolerance = ContourCheckOptions{}.plane_tolerance_mm;
    assign_planes(interpretation.result.contours, tolerance);
    note_omissions(interpretation);
    note_warped(interpretation, tolerance);
    mark_holes(interpretation);
    return std::move(interpretation.result);
}

}  // namespace kontur
