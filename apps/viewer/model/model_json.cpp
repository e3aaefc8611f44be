// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/model_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/derive/rule_names.h"
#include "kontur/io/bytes/check_json.h"
#include "kontur/io/contours/attributes_json.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::invalid_input, message); }

Vec3 vec3_from(const json& value, const char* key, double farthest_mm) {
    if (!value.is_array() || value.size() != 3) refuse(fmt::format("'{}' is not [x, y, z]", key));
    Vec3 v;
    for (int axis = 0; axis < 3; ++axis) {
        if (!value[static_cast<std::size_t>(axis)].is_number()) refuse(fmt::format("'{}' is not [x, y, z]", key));
        v[axis] = value[static_cast<std::size_t>(axis)].get<double>();
        if (!(std::abs(v[axis]) <= farthest_mm))
            refuse(fmt::format("'{}' has the coordinate {}; the limit is {:g} mm", key, v[axis], farthest_mm));
    }
    return v;
}

Vec3 unit_vector(const Members& members, const char* key) {
    const Vec3 v = members.point(key);
    if (!(std::abs(norm(v) - 1) <= 1e-3)) refuse(fmt::format("'{}' has length {:g}; 1 is needed", key, norm(v)));
    // What is a unit vector already keeps its last bits, so that a contour is the same after any number of trips.
    return std::abs(norm(v) - 1) <= 1e-12 ? v : normalized(v);
}

void make_orthonormal(Plane& plane) {
    const double skew = std::max(
        {std::abs(dot(plane.u, plane.normal)), std::abs(dot(plane.v, plane.normal)), std::abs(dot(plane.u, plane.v))});
    if (skew <= 1e-12) return;
    if (!(skew <= 1e-3))
        refuse(fmt::format("the axes of a plane are not perpendicular: a cosine is {:.2g}; the limit is 0.001", skew));
    plane.u = normalized(plane.u - dot(plane.u, plane.normal) * plane.normal);
    const Vec3 v = cross(plane.normal, plane.u);
    plane.v = dot(v, plane.v) < 0 ? -v : v;
}

}  // namespace

std::string to_text(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json parsed(std::string_view text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\') ++i;
        else if (c == '"') in_string = !in_string;
        else if (!in_string && (c == '[' || c == '{') && ++depth > kDeepest)
            refuse(fmt::format("the message is nested deeper than {} levels", kDeepest));
        else if (!in_string && (c == ']' || c == '}')) --depth;
    }
    json value = json::parse(text);
    try {
        check_json(text);
    } catch (const Error& error) {
        refuse(error.what());
    }
    return value;
}

json to_json(const Vec3& v) { return json::array({v.x, v.y, v.z}); }

json to_json(const std::vector<Vec3>& points) {
    json array = json::array();
    for (const Vec3& p : points) array.push_back(to_json(p));
    return array;
}

json to_json(const ExpectedDice& dice) { return {{"value", dice.value}, {"low", dice.low}, {"high", dice.high}}; }

json to_json(const SurfaceUncertainty& u) {
    json told{{"known", u.is_known}, {"planes", u.planes}, {"text", sentence(u)}};
    if (!u.is_known) return told;
    told["expected_dice"] = to_json(u.dice);
    told["planes_to_dice"] = {{"0.95", u.planes_to_95}, {"0.98", u.planes_to_98}};
    told["volume_ml"] = {{"low", u.volume_low_ml}, {"high", u.volume_high_ml}};
    told["half_width_mm"] = {{"median", u.half_width_median_mm}, {"p90", u.half_width_p90_mm}};
    told["farthest"] = {{"at", to_json(u.farthest_position)}, {"distance_mm", u.farthest_mm}};
    return told;
}

json to_json(const Plane& plane) {
    return {{"origin", to_json(plane.origin)},
            {"u", to_json(plane.u)},
            {"v", to_json(plane.v)},
            {"normal", to_json(plane.normal)}};
}

json to_json(const SurfacePoint& point) {
    json told{{"at", to_json(point.position)}};
    if (point.outward) told["outward"] = to_json(*point.outward);
    return told;
}

json to_json(const StructureMask& mask) {
    json told{{"hash", mask.hash}, {"reach", mask.reach}, {"drop_loose", mask.drop_loose}};
    if (!mask.source.empty()) told["source"] = mask.source;
    if (!mask.kept.empty()) told["kept"] = mask.kept;
    told["confirmed_planes"] = json::array();
    for (const Plane& plane : mask.confirmed_planes) told["confirmed_planes"].push_back(to_json(plane));
    return told;
}

json to_json(const Structure& s) {
    json told{{"id", s.id}, {"name", s.name}, {"color", s.color}, {"visible", s.visible}};
    if (s.smoothing) told["smoothing"] = *s.smoothing;
    if (s.label_value) told["label_value"] = *s.label_value;
    if (s.mask) told["mask"] = to_json(*s.mask);
    if (s.rule) told["rule"] = *s.rule;
    if (s.attributes != StructureAttributes{}) {
        json attributes = json::parse(to_json(s.attributes));
        if (attributes.contains("review")) told["review"] = std::move(attributes["review"]);
        attributes.erase("review");
        if (!attributes.empty()) told["attributes"] = std::move(attributes);
    }
    for (const Plane& plane : s.empty_planes) told["empty_planes"].push_back(to_json(plane));
    for (const SurfacePoint& point : s.surface_points) told["surface_points"].push_back(to_json(point));
    if (!s.interior.empty()) told["interior"] = to_json(s.interior);
    if (!s.exterior.empty()) told["exterior"] = to_json(s.exterior);
    return told;
}

json to_json(const ControlPoint& c) {
    json told{{"at", to_json(c.at)}, {"kind", name(c.kind)}, {"index", c.index}};
    if (c.image != 0) told["image"] = c.image;
    return told;
}

json to_json(const DrawnContour& c) {
    json control = json::array();
    for (const ControlPoint& point : c.control) control.push_back(to_json(point));
    json told{{"id", c.id},
              {"structure", c.structure},
              {"kind", kind_name(c)},
              {"plane", to_json(c.plane)},
              {"control", std::move(control)},
              {"points", to_json(c.points)},
              {"closed", c.closed},
              {"hole", c.hole},
              {"visible", c.visible}};
    if (c.inside) told["inside"] = std::string(name(*c.inside));
    if (c.end != ContourEnd::automatic) told["end"] = std::string(name(c.end));
    if (c.weight != 1) told["weight"] = c.weight;
    if (c.time) told["time"] = *c.time;
    return told;
}

Members::Members(const json& object, const Limits& limits) : object_(object), limits_(limits) {
    if (!object.is_object()) refuse("the message is no JSON object");
}

bool Members::has(const char* key) const { return object_.contains(key) && !object_[key].is_null(); }

const json& Members::at(const char* key) const {
    if (!has(key)) refuse(fmt::format("'{}' is missing", key));
    return object_[key];
}

double Members::number(const char* key) const {
    const json& value = at(key);
    if (!value.is_number()) refuse(fmt::format("'{}' is not a number", key));
    const double number = value.get<double>();
    if (!std::isfinite(number)) refuse(fmt::format("'{}' is not finite", key));
    return number;
}

double Members::number_or(const char* key, double fallback) const { return has(key) ? number(key) : fallback; }

std::int64_t Members::integer(const char* key, std::int64_t least, std::int64_t most) const {
    const json& value = at(key);
    // An unsigned number beyond int64 would wrap; comparing it as a double keeps it out.
    if (!value.is_number_integer() || value.get<double>() < static_cast<double>(least) ||
        value.get<double>() > static_cast<double>(most))
        refuse(fmt::format("'{}' is not a whole number from {} to {}", key, least, most));
    return value.get<std::int64_t>();
}

Id Members::id(const char* key) const { return integer(key, 1, kLargestId); }

bool Members::flag(const char* key) const {
    if (!at(key).is_boolean()) refuse(fmt::format("'{}' is neither true nor false", key));
    return at(key).get<bool>();
}

bool Members::flag_or(const char* key, bool fallback) const { return has(key) ? flag(key) : fallback; }

std::string Members::text(const char* key, std::size_t most) const {
    if (!at(key).is_string()) refuse(fmt::format("'{}' is not a text", key));
    std::string text = at(key).get<std::string>();
    if (text.size() > most) refuse(fmt::format("'{}' has {} bytes; the limit is {}", key, text.size(), most));
    return text;
}

Vec3 Members::point(const char* key) const { return vec3_from(at(key), key, limits_.farthest_mm); }

std::vector<Vec3> Members::points(const char* key) const {
    const json& array = at(key);
    if (!array.is_array()) refuse(fmt::format("'{}' is not an array of points", key));
    if (array.size() > limits_.points)
        refuse(fmt::format("'{}' has {} points; the limit is {}", key, array.size(), limits_.points));
    std::vector<Vec3> points;
    points.reserve(array.size());
    for (const json& item : array) points.push_back(vec3_from(item, key, limits_.farthest_mm));
    return points;
}

Plane Members::plane(const char* key) const {
    const Members members(at(key), limits_);
    Plane plane{members.point("origin"), unit_vector(members, "normal"), unit_vector(members, "u"),
                unit_vector(members, "v")};
    make_orthonormal(plane);
    return plane;
}

int Members::image(const char* key) const { return has(key) ? static_cast<int>(integer(key, 0, kMostImages - 1)) : 0; }

std::optional<int> Members::time() const {
    if (!has("time")) return std::nullopt;
    return static_cast<int>(integer("time", 0, 99'999));
}

std::vector<Plane> Members::planes(const char* key, std::size_t most) const {
    const json& array = at(key);
    if (!array.is_array() || array.size() > most) refuse(fmt::format("'{}' is no array of at most {} planes", key, most));
    std::vector<Plane> planes;
    for (const json& item : array) {
        const json named{{key, item}};
        planes.push_back(Members(named, limits_).plane(key));
    }
    return planes;
}

std::vector<SurfacePoint> Members::surface_points(const char* key) const {
    const json& array = at(key);
    if (!array.is_array() || array.size() > kMostSinglePoints)
        refuse(fmt::format("'{}' is no array of at most {} points", key, kMostSinglePoints));
    std::vector<SurfacePoint> points;
    for (const json& item : array) {
        const Members point(item, limits_);
        points.push_back({point.point("at"), {}});
        if (point.has("outward")) points.back().outward = unit_vector(point, "outward");
    }
    return points;
}

Stretch Members::stretch(const char* key) const {
    const std::string word = text(key, 16);
    for (const Stretch kind : {Stretch::free, Stretch::line, Stretch::spline, Stretch::wire})
        if (word == name(kind)) return kind;
    refuse(fmt::format("'{}' is none of free, line, spline and wire", key));
}

Hand Members::hand(const char* key) const {
    const std::string word = text(key, 16);
    for (const Hand hand : {Hand::left, Hand::right})
        if (word == name(hand)) return hand;
    refuse(fmt::format("'{}' is neither left nor right", key));
}

ContourEnd Members::end(const char* key) const {
    const std::string word = text(key, 16);
    for (const ContourEnd end : {ContourEnd::automatic, ContourEnd::flat, ContourEnd::round})
        if (word == name(end)) return end;
    refuse(fmt::format("'{}' is none of automatic, flat and round", key));
}

double Members::weight(const char* key) const {
    const double value = number(key);
    if (value < kLeastWeight || value > kMostWeight)
        refuse(fmt::format("'{}' is {}; it must lie between {} and {}", key, value, kLeastWeight, kMostWeight));
    return value;
}

std::string Members::color(const char* key) const {
    std::string color = text(key, 7);
    const auto is_hex = [](unsigned char c) { return std::isxdigit(c) != 0; };
    if (color.size() != 7 || color[0] != '#' || !std::all_of(color.begin() + 1, color.end(), is_hex))
        refuse(fmt::format("'{}' is no colour like #e8b04a", key));
    return color;
}

std::optional<double> Members::smoothing(const char* key) const {
    constexpr double kMost = 1;
    if (at(key) == "usual") return std::nullopt;
    const double value = number(key);
    if (value < 0 || value > kMost) refuse(fmt::format("'{}' is {}; it must lie between 0 and {}", key, value, kMost));
    return value;
}

std::optional<std::int64_t> Members::label_value(const char* key) const {
    if (at(key) == "automatic") return std::nullopt;
    return integer(key, 1, kLargestLabelValue);
}

double Members::reach(const char* key) const {
    constexpr double kLeast = 0.25, kMost = 4;  // of CorrectOptions
    const double value = number(key);
    if (value < kLeast || value > kMost)
        refuse(fmt::format("'{}' is {}; it must lie between {} and {}", key, value, kLeast, kMost));
    return value;
}

StructureMask mask_from_json(const json& value) {
    constexpr std::size_t kHashBytes = 64;
    const Members m(value, kStoredLimits);
    return {m.text("hash", kHashBytes),
            m.planes("confirmed_planes"),
            m.reach("reach"),
            m.flag("drop_loose"),
            m.has("source") ? m.text("source", kMostNameBytes) : "",
            m.has("kept") ? m.text("kept", kHashBytes) : ""};
}

Structure structure_from_json(const json& value) {
    const Members m(value, kStoredLimits);
    Structure structure{m.id("id"), m.text("name", kMostNameBytes), m.color("color"), m.flag("visible")};
    if (m.has("empty_planes")) structure.empty_planes = m.planes("empty_planes");
    if (m.has("smoothing")) structure.smoothing = m.smoothing("smoothing");
    if (m.has("label_value")) structure.label_value = m.label_value("label_value");
    if (m.has("surface_points")) structure.surface_points = m.surface_points("surface_points");
    if (m.has("interior")) structure.interior = m.points("interior");
    if (m.has("exterior")) structure.exterior = m.points("exterior");
    if (m.has("mask")) structure.mask = mask_from_json(m.at("mask"));
    if (m.has("rule")) structure.rule = m.text("rule", kMostRuleBytes);
    if (structure.rule && name_made(*structure.rule) != structure.name)
        refuse(fmt::format("the rule {} does not make {}", *structure.rule, structure.name));
    json attributes = m.has("attributes") ? m.at("attributes") : json::object();
    if (m.has("review")) attributes["review"] = m.at("review");
    structure.attributes = attributes_from_json(attributes.dump());
    return structure;
}

DrawnContour contour_from_json(const json& value, const Limits& limits) {
    const Members m(value, limits);
    DrawnContour c;
    c.id = m.id("id");
    c.structure = m.id("structure");
    c.plane = m.plane("plane");
    c.points = m.points("points");
    c.closed = m.flag_or("closed", true);  // of projects from before there were open lines
    c.hole = m.flag("hole");
    c.visible = m.flag("visible");
    if (m.has("inside")) c.inside = m.hand("inside");
    if (m.has("end")) c.end = m.end("end");
    if (m.has("weight")) c.weight = m.weight("weight");
    c.time = m.time();
    if (c.end != ContourEnd::automatic && (!c.closed || c.hole))
        refuse("a contour that is open or a hole says how the structure ends there; only others can");
    if (!c.closed && c.hole) refuse("a contour is open and a hole; only closed contours can be holes");
    if (c.closed && c.inside) refuse("a contour is closed and says on which hand the structure lies");
    if (!m.at("control").is_array() || m.at("control").empty()) refuse("a contour has no control points");
    for (const json& item : m.at("control")) {
        const Members point(item, limits);
        const auto last = static_cast<std::int64_t>(c.points.size()) - 1;
        const std::int64_t least = c.control.empty() ? 0 : static_cast<std::int64_t>(c.control.back().index) + 1;
        c.control.push_back({point.point("at"), point.stretch("kind"),
                             static_cast<std::size_t>(point.integer("index", least, c.control.empty() ? 0 : last)),
                             point.image("image")});
    }
    return c;
}

}  // namespace kontur::viewer
