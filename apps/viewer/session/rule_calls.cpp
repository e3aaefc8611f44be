// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/derive/derive.h"
#include "kontur/derive/rule_names.h"
#include "kontur/derive/rule_words.h"
#include "viewer/model/model_json.h"
#include "viewer/model/names.h"
#include "viewer/model/status_line.h"
#include "viewer/model/structure_rules.h"
#include "viewer/session/calls.h"
#include "viewer/session/history.h"
#include "viewer/surfaces/clipped_volume.h"

// Structures that rules make of others (docs/derive.md).

namespace kontur::viewer {
namespace {

using nlohmann::json;

/// Whether nobody has drawn anything of it or said anything about it.
bool is_bare(const State& state, const Structure& structure) {
    return !has_content(state, structure.id) && structure.surface_points.empty() && structure.interior.empty() &&
           structure.exterior.empty() && structure.empty_planes.empty();
}

/// The structure that a line makes: one that is there and has nothing else, or a rule already; else a new one, with id 0.
Structure structure_for(const State& state, const std::string& line) {
    const std::string name = name_made(line);
    check_name(name);
    const std::size_t place = line.find_first_not_of(" \t\r\n");
    if (name.size() > kMostNameBytes)
        throw RuleError(line, place, fmt::format("the name has {} bytes; the limit is {}", name.size(), kMostNameBytes));
    Structure structure;
    structure.name = name;
    for (const auto& [id, one] : state.structures) {
        if (one.name != name) continue;
        if (structure.id != 0)
            throw RuleError(line, place, fmt::format("2 structures are named {}; rename one of them", name));
        if (!one.rule && !is_bare(state, one))
            throw RuleError(line, place, fmt::format("'{}' is there; give what the rule makes another name", name));
        structure = one;
    }
    structure.rule = line;
    return structure;
}

/// As the project would be with the rule. Throws RuleError for what is wrong with it.
State with_rule(State state, const Structure& structure) {
    state.structures[structure.id] = structure;
    std::vector<std::string> rules{*structure.rule}, names;
    for (const auto& [id, one] : state.structures) {
        if (!one.rule) names.push_back(one.name);
        else if (id != structure.id) rules.push_back(*one.rule);
    }
    check_rules(rules, names, true);
    members_of(state, structure.id);
    return state;
}

/// Characters before a place, as the page counts them (UTF-16).
std::size_t characters_before(const std::string& text, std::size_t place) {
    std::size_t count = 0;
    for (std::size_t n = 0; n < std::min(place, text.size()); ++n) {
        const auto byte = static_cast<unsigned char>(text[n]);
        count += (byte & 0xC0) != 0x80 ? (byte >= 0xF0 ? 2 : 1) : 0;
    }
    return count;
}

json check(SessionState& s, const Members& m) {
    const std::string line = m.text("line", kMostRuleBytes);
    try {
        const Structure structure = structure_for(s.project.state(), line);
        with_rule(s.project.state(), structure);
        return {{"name", structure.name}, {"is_new", structure.id == 0}};
    } catch (const RuleError& error) {
        json problem{{"text", error.sentence()}};
        if (error.rule() == line) problem["at"] = characters_before(line, error.place());
        return {{"problem", std::move(problem)}};
    } catch (const Error& error) {
        return {{"problem", {{"text", error.what()}}}};
    }
}

/// What the line would make of what is seen just now, and where that meets planes.
json preview(SessionState& s, const Members& m) {
    const std::string line = m.text("line", kMostRuleBytes);
    const State now = s.state();
    const Structure structure = structure_for(now, line);
    const RuleTask task{members_of(with_rule(now, structure), structure.id), s.image.voxels};
    Surface surface;
    surface.mesh = std::make_shared<const TriangleMesh>(s.surfaces.preview_of(task));
    json planes = json::array();
    if (m.has("planes"))
        for (const Plane& plane : m.planes("planes")) {
            json lines = json::array();
            for (const std::vector<Vec3>& points : cutters(surface).surface(plane)) lines.push_back(to_json(points));
            planes.push_back(std::move(lines));
        }
    return {{"volume_ml", volume_within_mm3(*surface.mesh, s.image.voxels->grid) / 1000}, {"lines", std::move(planes)}};
}

json set_rule(SessionState& s, const Members& m) {
    const std::string line = m.text("line", kMostRuleBytes);
    const State& state = s.project.state();
    Structure structure = structure_for(state, line);
    with_rule(state, structure);
    Change<Structure> change;
    if (structure.id == 0) {
        const Id id = s.project.new_id();
        structure = {id, structure.name, next_color(state), true};
        structure.rule = line;
    } else {
        change.before = structure_of(state, structure.id);
    }
    change.id = structure.id;
    change.after = structure;
    const bool is_change = change.before && change.before->rule;
    commit(s, {fmt::format("{} {}", is_change ? "Change the rule of" : "Add", structure.name), {change}, {}});
    return {{"structure", to_json(structure)}};
}

/// It becomes a mask, which nothing else changes any more and which can be corrected.
json freeze(SessionState& s, const Members& m) {
    const State now = s.state();
    const Structure before = s.present_structure(now, m.id("id"));
    if (!before.rule)
        throw Error(ErrorKind::invalid_input, fmt::format("{} is made by no rule, so nothing moves it", before.name));
    const StatusLine line(s.pages.status_teller(), "Freezing " + before.name);
    const auto fit = s.fits.one(now, before.id, line.work({}), {.mesh = false});
    const auto mask = std::make_shared<const StoredMask>(fit->segmentation.mask);
    Structure after = before;
    after.rule.reset();
    after.mask = StructureMask{.hash = mask->hash(), .source = "kontur derive"};
    after.attributes = fit->set.attributes;
    after.attributes.color.reset();
    after.attributes.review = before.attributes.review;
    const std::scoped_lock lock(s.mutex);
    if (structure_of(s.project.state(), before.id) != before)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} has been changed meanwhile; freeze it once more", before.name));
    Commit step{"Freeze " + before.name, {{before.id, before, after}}, {}};
    step.masks.push_back(mask);
    commit(s, step);
    return {{"structure", to_json(after)}};
}

}  // namespace

Calls rule_calls() {
    return {{"rule.check", {check}},
            {"rule.preview", {preview, false}},
            {"rule.set", {set_rule}},
            {"structure.freeze", {freeze, false}}};
}

}  // namespace kontur::viewer
