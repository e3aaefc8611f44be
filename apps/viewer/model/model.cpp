// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "viewer/model/file_names.h"

namespace kontur::viewer {
namespace {

bool all_of_kind(const DrawnContour& contour, Stretch kind) {
    const bool ends_there = !contour.closed && contour.control.size() > 1;  // no stretch leads on from an open line's end
    return std::all_of(contour.control.begin(), contour.control.end() - (ends_there ? 1 : 0),
                       [&](const ControlPoint& c) { return c.kind == kind; });
}

std::shared_ptr<const StoredMask> mask_named(const std::string& hash, const State& state, const Structure& structure) {
    const auto found = state.masks.find(hash);
    if (found == state.masks.end())
        throw Error(ErrorKind::invalid_input, fmt::format("the mask of {} is not there", structure.name));
    return found->second;
}

}  // namespace

std::string_view name(Stretch kind) noexcept {
    switch (kind) {
        case Stretch::line:
            return "line";
        case Stretch::spline:
            return "spline";
        case Stretch::wire:
            return "wire";
        case Stretch::free:
            break;
    }
    return "free";
}

std::string_view kind_name(const DrawnContour& contour) noexcept {
    if (all_of_kind(contour, Stretch::free)) return "freehand";
    if (all_of_kind(contour, Stretch::spline)) return "spline";
    if (all_of_kind(contour, Stretch::wire)) return "livewire";
    return "mixed";
}

DrawnContour as_drawn(const Contour& contour) {
    DrawnContour drawn;
    drawn.plane = contour.plane;
    drawn.points = contour.points;
    copy_marks(contour, drawn);
    if (!drawn.points.empty()) drawn.control.push_back({drawn.points.front(), Stretch::free, 0});
    if (!drawn.closed && drawn.points.size() > 1)
        drawn.control.push_back({drawn.points.back(), Stretch::free, drawn.points.size() - 1});
    return drawn;
}

Contour as_contour(const DrawnContour& drawn) {
    Contour contour{.plane = drawn.plane, .points = drawn.points};
    copy_marks(drawn, contour);
    return contour;
}

StructureAttributes attributes_of(const Structure& structure) {
    StructureAttributes attributes = structure.attributes;
    attributes.color = rgb8(structure.color);
    return attributes;
}

ContourSet without_contours(const Structure& s) {
    return {s.name, {}, s.interior, s.exterior, s.surface_points, s.empty_planes, attributes_of(s)};
}

std::shared_ptr<const StoredMask> mask_of(const State& state, const Structure& structure) {
    return structure.mask ? mask_named(structure.mask->hash, state, structure) : nullptr;
}

std::shared_ptr<const StoredMask> kept_mask_of(const State& state, const Structure& structure) {
    if (!structure.mask || structure.mask->kept.empty()) return nullptr;
    return mask_named(structure.mask->kept, state, structure);
}

bool has_content(const State& state, Id structure) {
    const auto own = state.structures.find(structure);
    return (own != state.structures.end() && (own->second.mask || own->second.rule)) ||
           std::ranges::any_of(state.contours, [&](const auto& item) { return item.second->structure == structure; });
}

bool counts(const DrawnContour& contour, const Structure& structure) { return contour.visible || !structure.mask; }

ContourSet contour_set(const State& state, Id structure) {
    const Structure& own = structure_of(state, structure);
    ContourSet set = without_contours(own);
    std::vector<int> times;
    for (const auto& [id, contour] : state.contours) {
        if (contour->structure != structure || !counts(*contour, own)) continue;
        set.contours.push_back(as_contour(*contour));
        times.push_back(time_of(state, *contour));
    }
    if (is_moving(state, structure)) set_frames(set, times, state);
    return set;
}

int time_of(const State& state, const DrawnContour& contour) { return contour.time.value_or(state.opened_time); }

std::set<int> drawn_times(const State& state, Id structure) {
    std::set<int> times;
    for (const auto& [id, contour] : state.contours)
        if (contour->structure == structure) times.insert(time_of(state, *contour));
    return times;
}

bool is_moving(const State& state, Id structure) {
    const auto own = state.structures.find(structure);
    return own != state.structures.end() && !own->second.mask && drawn_times(state, structure).size() > 1;
}

void set_frames(ContourSet& set, const std::vector<int>& times, const State& state) {
    for (std::size_t n = 0; n < set.contours.size(); ++n) set.contours[n].frame = times[n] + 1;
    if (state.cycle_frames.value_or(0) > 0) set.cycle_frames = state.cycle_frames;
}

namespace {
constexpr double kParallelCosine = 0.99985;
}

bool is_same_plane(const Plane& a, const Plane& b) {
    constexpr double kNear_mm = 1e-3;
    return std::abs(dot(a.normal, b.normal)) >= kParallelCosine && std::abs(a.distance_to(b.origin)) <= kNear_mm &&
           std::abs(b.distance_to(a.origin)) <= kNear_mm;
}

bool lies_in(const DrawnContour& contour, const Plane& plane, double thickness_mm) {
    return std::abs(dot(contour.plane.normal, plane.normal)) >= kParallelCosine &&
           std::all_of(contour.points.begin(), contour.points.end(),
                       [&](const Vec3& p) { return std::abs(plane.distance_to(p)) <= 0.5 * thickness_mm; });
}

const Structure& structure_of(const State& state, Id id) {
    const auto found = state.structures.find(id);
    if (found == state.structures.end())
        throw Error(ErrorKind::invalid_input, fmt::format("there is no structure with the id {}", id));
    return found->second;
}

const DrawnContour& contour_of(const State& state, Id id) {
    const auto found = state.contours.find(id);
    if (found == state.contours.end())
        throw Error(ErrorKind::invalid_input, fmt::format("there is no contour with the id {}", id));
    return *found->second;
}

}  // namespace kontur::viewer
