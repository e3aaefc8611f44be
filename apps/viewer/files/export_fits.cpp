// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/export_fits.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "kontur/base/error.h"
#include "viewer/files/derived_fits.h"

namespace kontur::viewer {
namespace {

constexpr std::size_t kMostBytes = std::size_t{512} << 20;
constexpr std::size_t kMostKept = 8;

/// But for what reviewers say, which changes no fit.
bool is_same(const Structure& a, const Structure& b) {
    Structure same = a;
    same.attributes.review = b.attributes.review;
    return same == b;
}

bool is_same(const State& a, const State& b) {
    const auto are_same = [](const auto& x, const auto& y) { return x.first == y.first && is_same(x.second, y.second); };
    return std::ranges::equal(a.structures, b.structures, are_same) && a.borders == b.borders &&
           a.use_image == b.use_image && a.cycle_frames == b.cycle_frames &&
           std::ranges::equal(a.contours, b.contours, [](const auto& x, const auto& y) {
               return x.first == y.first && (x.second == y.second || *x.second == *y.second);
           });
}

void put_review(FittedStructure& one, const State& state) {
    const Review& review = structure_of(state, one.structure.id).attributes.review;
    one.structure.attributes.review = one.set.attributes.review = review;
}

bool has_reviews_of(const std::vector<FittedStructure>& fits, const State& state) {
    return std::ranges::all_of(fits, [&](const FittedStructure& one) {
        return one.structure.attributes.review == structure_of(state, one.structure.id).attributes.review;
    });
}

State without_rules(State state) {
    std::erase_if(state.structures, [](const auto& item) { return item.second.rule.has_value(); });
    return state;
}

std::set<Id> drawn_in(const State& state) {
    std::set<Id> drawn;
    for (const auto& [id, contour] : state.contours) drawn.insert(contour->structure);
    for (const auto& [id, structure] : state.structures)
        if (structure.mask) drawn.insert(id);
    return drawn;
}

/// What of the state says how this structure runs where it shares no border.
State only(const State& state, Id structure) {
    State own = state;
    own.borders = {};
    std::erase_if(own.structures, [&](const auto& item) { return item.first != structure; });
    std::erase_if(own.contours, [&](const auto& item) { return item.second->structure != structure; });
    return own;
}

/// Only these.
State only(const State& state, const std::map<std::string, Id>& structures) {
    State own = state;
    own.borders = {};
    const auto is_one = [&](Id id) {
        return std::ranges::any_of(structures, [&](const auto& item) { return item.second == id; });
    };
    std::erase_if(own.structures, [&](const auto& item) { return !is_one(item.first); });
    std::erase_if(own.contours, [&](const auto& item) { return !is_one(item.second->structure); });
    return own;
}

/// Whether it is a structure of the opened time, and of no other.
bool is_of_opened_time(const State& state, Id structure) {
    const std::set<int> times = drawn_times(state, structure);
    return structure_of(state, structure).mask || times.empty() || times == std::set{state.opened_time};
}

/// Without what was drawn at other times.
State at_opened_time_alone(const State& state) {
    State own = state;
    std::erase_if(own.contours, [&](const auto& item) { return !is_of_opened_time(state, item.second->structure); });
    return own;
}

std::size_t bytes_of(const ExportFits::Fits& fits) {
    std::size_t bytes = 0;
    for (const FittedStructure& one : *fits) {
        bytes += one.segmentation.mask.values.size();
        if (one.corrected) bytes += 2 * one.corrected->origin.size();
        if (one.segmentation.mesh)
            bytes += one.segmentation.mesh->points.size() * sizeof(Vec3) +
                     one.segmentation.mesh->triangles.size() * sizeof(one.segmentation.mesh->triangles.front());
    }
    return bytes;
}

}  // namespace

ExportFits::Fits ExportFits::all(const State& state, const Work& work, const FitWish& wish) {
    const State own = at_opened_time_alone(state);
    if (own.contours.size() == state.contours.size()) return at_opened_time(state, wish.mesh, work);
    std::vector<FittedStructure> all;
    if (!drawn_in(own).empty() || !all_members(own).derived.empty()) all = *at_opened_time(own, wish.mesh, work);
    for (const Id id : drawn_in(state))
        if (!is_of_opened_time(state, id)) all.push_back(in_time(state, id, wish, work));
    std::ranges::sort(all, {}, [](const FittedStructure& one) { return one.structure.id; });
    return std::make_shared<const std::vector<FittedStructure>>(std::move(all));
}

FittedStructure ExportFits::in_time(const State& state, Id structure, const FitWish& wish, const Work& work) {
    if (is_moving(state, structure)) {
        FittedStructure moving = motion(state, structure, work)->at(wish.time.value_or(state.opened_time));
        put_review(moving, state);
        return moving;
    }
    const State own = only(state, structure);
    const Fits fits = kept(own, wish.mesh, [&] {
        const std::shared_ptr<const Image> image = image_at_(*drawn_times(state, structure).begin());
        return std::vector{fit_structure(own, structure, *image, wish.mesh, work)};
    });
    return fits->front();
}

std::shared_ptr<const FittedMotion> ExportFits::motion(const State& state, Id structure, const Work& work) {
    const State own = only(state, structure);
    {
        const std::scoped_lock lock(mutex_);
        const auto known = std::ranges::find_if(motions_, [&](const auto& one) { return is_same(one.state, own); });
        if (known != motions_.end()) {
            motions_.splice(motions_.begin(), motions_, known);
            return known->motion;
        }
    }
    FramesToSegment frames(image_->grid);
    if (own.use_image) frames.image_at = [this](double frame) { return image_at_(static_cast<int>(frame) - 1); };
    auto motion = std::make_shared<const FittedMotion>(own, structure, frames, times_, work);
    const std::scoped_lock lock(mutex_);
    motions_.push_front({own, motion});
    std::size_t bytes = 0;
    std::erase_if(motions_, [&](const MotionOfState& one) {
        return (bytes += one.motion->bytes()) > kMostBytes && one.motion != motion;
    });
    return motion;
}

ExportFits::Fits ExportFits::at_opened_time(const State& state, bool mesh, const Work& work) {
    const RuleMembers derived = all_members(state);
    if (derived.derived.empty()) return drawn_at_opened_time(without_rules(state), mesh, work);
    return kept(state, mesh, [&] {
        std::vector<FittedStructure> all;
        if (!drawn_in(state).empty()) all = *drawn_at_opened_time(without_rules(state), mesh, work);
        const DeriveOptions options{image_.get(), find_body(work), mesh};
        for (FittedStructure& one : fit_derived(derived, all, state, options, work)) all.push_back(std::move(one));
        std::ranges::sort(all, {}, [](const FittedStructure& one) { return one.structure.id; });
        return all;
    });
}

ExportFits::Fits ExportFits::drawn_at_opened_time(const State& state, bool mesh, const Work& work) {
    const std::set<Id> drawn = drawn_in(state);
    const State part = drawn.size() == 1 ? only(state, *drawn.begin()) : state;
    return kept(part, mesh, [&] { return fit_structures(part, *image_, mesh, work); });
}

FindBody ExportFits::find_body(const Work& work) const {
    return [this, &work](const std::optional<double>& threshold) { return bodies_->at(*image_, threshold, work.untold()); };
}

std::shared_ptr<const FittedStructure> ExportFits::derived(const State& state, Id structure, bool mesh, const Work& work) {
    const RuleMembers members = members_of(state, structure);
    for (const auto& [name, id] : members.drawn)
        if (!has_content(state, id))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{}: {} has 0 contours; at least 1 is needed", members.rules.front(), name));
    State own = state.borders.shared ? state : only(state, members.drawn);
    for (const Id id : members.derived) own.structures[id] = structure_of(state, id);
    const Fits fits = at_opened_time(own, mesh, work);
    return {fits, &*std::ranges::find(*fits, structure, [](const FittedStructure& one) { return one.structure.id; })};
}

std::shared_ptr<const FittedStructure> ExportFits::one(const State& all_of_it, Id structure, const Work& work,
                                                       const FitWish& wish) {
    if (!is_of_opened_time(all_of_it, structure))
        return std::make_shared<const FittedStructure>(in_time(all_of_it, structure, wish, work));
    if (structure_of(all_of_it, structure).rule) return derived(at_opened_time_alone(all_of_it), structure, wish.mesh, work);
    const State state = at_opened_time_alone(without_rules(all_of_it));
    const std::set<Id> drawn = drawn_in(state);
    const bool is_alone = drawn.size() == 1 || !drawn.contains(structure);
    if (state.borders.shared && !is_alone) {
        const Fits fits = drawn_at_opened_time(state, wish.mesh, work);
        const auto chosen = std::ranges::find(*fits, structure, [](const FittedStructure& one) { return one.structure.id; });
        return {fits, &*chosen};
    }
    const State own = only(state, structure);
    const Fits fits =
        kept(own, wish.mesh, [&] { return std::vector{fit_structure(own, structure, *image_, wish.mesh, work)}; });
    return {fits, &fits->front()};
}

ExportFits::Fits ExportFits::kept(const State& state, bool mesh, const std::function<std::vector<FittedStructure>()>& fit) {
    {
        const std::scoped_lock lock(mutex_);
        const auto known = std::ranges::find_if(
            kept_, [&](const FitsOfState& one) { return (one.mesh || !mesh) && is_same(one.state, state); });
        if (known != kept_.end()) {
            kept_.splice(kept_.begin(), kept_, known);
            if (!has_reviews_of(*known->fits, state)) {
                auto reviewed = std::make_shared<std::vector<FittedStructure>>(*known->fits);
                for (FittedStructure& one : *reviewed) put_review(one, state);
                known->fits = std::move(reviewed);
            }
            return known->fits;
        }
    }
    const Fits fits = std::make_shared<const std::vector<FittedStructure>>(fit());
    const std::scoped_lock lock(mutex_);
    kept_.push_front({state, mesh, fits});
    std::size_t bytes = 0, count = 0;
    std::erase_if(kept_,
                  [&](const FitsOfState& one) { return (bytes += bytes_of(one.fits)) > kMostBytes || ++count > kMostKept; });
    return fits;
}

}  // namespace kontur::viewer
