// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/shape/contour.h"
#include "viewer/model/border_rules.h"
#include "viewer/model/stored_mask.h"

// What a project holds: structures and the contours drawn for them.

namespace kontur::viewer {

/// How the line from one control point to the next was made.
enum class Stretch { free, line, spline, wire };
std::string_view name(Stretch kind) noexcept;

/// A point to drag.
struct ControlPoint {
    Vec3 at;
    Stretch kind = Stretch::free;  ///< of the line to the next control point; the last one's leads to the first, or would
    std::size_t index = 0;         ///< where that line starts in the contour's points; `points[index] == at`
    int image = 0;                 ///< number of the image whose edges it follows, where it is a wire

    friend bool operator==(const ControlPoint&, const ControlPoint&) = default;
};

struct DrawnContour {
    Id id = 0;
    Id structure = 0;
    Plane plane;
    std::vector<ControlPoint> control;  ///< at least one, by growing index, the first at index 0
    std::vector<Vec3> points;           ///< the closed polygon, or the open line, in mm, on the plane
    bool hole = false;
    bool visible = true;
    bool closed = true;                      ///< false: a stretch of the border; its last control point is its last point
    std::optional<Hand> inside{};            ///< of an open line: where the structure lies; unset: to be found out
    ContourEnd end = ContourEnd::automatic;  ///< of a closed line that is no hole
    double weight = 1;                       ///< how far it is trusted
    std::optional<int> time{};               ///< of an image of several volumes the one it was drawn in, from 0; unset: the
                                             ///< one that was opened

    friend bool operator==(const DrawnContour&, const DrawnContour&) = default;
};

/// What a line is besides its points; both have these members.
template <class From, class To>
void copy_marks(const From& from, To& to) {
    to.hole = from.hole;
    to.closed = from.closed;
    to.inside = from.inside;
    to.end = from.end;
    to.weight = from.weight;
}

/// "freehand", "spline", "livewire" when all stretches are of that kind, else "mixed".
std::string_view kind_name(const DrawnContour& contour) noexcept;

/// A contour of a file, or drawn by others: one free stretch.
DrawnContour as_drawn(const Contour& contour);

/// As the library takes it.
Contour as_contour(const DrawnContour& contour);

constexpr std::int64_t kLargestLabelValue = 65535;  ///< that label maps are written with

/// Of a structure that is a mask to be corrected: its contours replace outlines of that mask, or pieces of them.
struct StructureMask {
    std::string hash{};                     ///< names the mask among the project's
    std::vector<Plane> confirmed_planes{};  ///< that were looked at, and in which the mask is right
    double reach = 1;                       ///< how far corrections are carried on, of what follows from the mask
    bool drop_loose = false;                ///< whether pieces that a correction cuts off are taken away
    std::string source{};                   ///< what made the mask, as its file said; "" where that said nothing
    std::string kept{};                     ///< of a locked structure: names the mask that it stays; "" where none is kept

    friend bool operator==(const StructureMask&, const StructureMask&) = default;
};

struct Structure {
    Id id = 0;
    std::string name;
    std::string color = "#e8b04a";  ///< "#rrggbb"
    bool visible = true;
    std::vector<Plane> empty_planes{};           ///< in which nothing of it is seen
    std::optional<double> smoothing{};           ///< of the fit (SegmentOptions); unset: the usual one
    std::vector<SurfacePoint> surface_points{};  ///< that its surface passes
    std::vector<Vec3> interior{}, exterior{};    ///< points that lie inside, outside of it
    StructureAttributes attributes{};            ///< what its file said of it, for exports; without the colour, see above
    std::optional<std::int64_t> label_value{};   ///< in label maps; unset: one that no other structure has
    std::optional<StructureMask> mask{};         ///< that the contours correct; unset: they are all there is of it
    std::optional<std::string> rule{};  ///< that makes it of others, as "PTV = CTV + 5 mm"; it has nothing else then

    friend bool operator==(const Structure&, const Structure&) = default;
};

/// All of a project at one moment. Contours are shared between moments, so a copy is cheap.
struct State {
    std::map<Id, Structure> structures;
    std::map<Id, std::shared_ptr<const DrawnContour>> contours;
    Borders borders;
    bool use_image = true;                 ///< between the contours, where it helps
    std::optional<double> cycle_frames{};  ///< after which motion repeats; 0: never; unset: nobody has said
    int opened_time = 0;                   ///< of the image's volumes the one that was opened, from 0; not stored
    /// By their hashes: those to be corrected, and those of the history.
    std::map<std::string, std::shared_ptr<const StoredMask>> masks{};
};

/// What files say of the structure, its colour among it.
StructureAttributes attributes_of(const Structure& structure);

/// What is known of the structure beside its contours, as the library takes it.
ContourSet without_contours(const Structure& structure);

/// The mask that the structure's contours correct; null for one that has none. Throws Error(invalid_input) for a mask that
/// the state does not hold.
std::shared_ptr<const StoredMask> mask_of(const State& state, const Structure& structure);
/// The mask that the locked structure stays, whatever becomes of its neighbours; null where none is kept. Throws likewise.
std::shared_ptr<const StoredMask> kept_mask_of(const State& state, const Structure& structure);

/// Whether there is anything of it: contours, a mask, or a rule that makes it.
bool has_content(const State& state, Id structure);

/// Whether a contour is one of what its structure is made of: a hidden correction of a mask is not.
bool counts(const DrawnContour& contour, const Structure& structure);
/// The structure's contours as the library takes them, in the order they were made; those that count. They have their
/// frames, and the cycle, where they are of several.
ContourSet contour_set(const State& state, Id structure);

/// The volume in time that the contour belongs to, from 0.
int time_of(const State& state, const DrawnContour& contour);
/// Those at which something of the structure was drawn, in order.
std::set<int> drawn_times(const State& state, Id structure);
/// Whether the structure was drawn at several times; a mask to be corrected does not move.
bool is_moving(const State& state, Id structure);
/// With frames, from 1, of contours in the order of the set, and the cycle.
void set_frames(ContourSet& set, const std::vector<int>& times, const State& state);

/// Whether the contour is drawn in this plane: parallel to it within a degree, and all of it within half of the thickness.
bool lies_in(const DrawnContour& contour, const Plane& plane, double thickness_mm);

/// Whether they are the same plane, to a thousandth of a millimetre at their origins.
bool is_same_plane(const Plane& a, const Plane& b);

/// Throws Error(invalid_input) naming the id when there is none.
const Structure& structure_of(const State& state, Id id);
const DrawnContour& contour_of(const State& state, Id id);

}  // namespace kontur::viewer
