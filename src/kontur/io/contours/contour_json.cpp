// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours/contour_json.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/json_file.h"
#include "kontur/io/contours/attributes_members.h"
#include "kontur/io/geometry/patient_frame.h"

namespace kontur {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;

[[noreturn]] void corrupt(const std::string& message) { throw Error(ErrorKind::corrupt_file, message); }

PatientFrame read_frame(const json& document) {
    const json& frame = member(document, "frame");
    if (frame == "LPS mm") return PatientFrame::lps;
    if (frame == "RAS mm") return PatientFrame::ras;
    throw Error(ErrorKind::unsupported, "the frame is " + quoted(frame) + "; \"LPS mm\" and \"RAS mm\" are supported");
}

void check_version(const json& document) {
    if (document.is_object() && !document.contains("frame") && !document.contains("planes"))
        corrupt("holds no contours: there is neither 'frame' nor 'planes'");
    if (!document.contains("version")) return;
    const json& version = document["version"];
    if (!version.is_number_integer()) corrupt("'version' is not a whole number");
    if (version != kVersion)
        throw Error(ErrorKind::unsupported, fmt::format("the version is {}; {} is supported", quoted(version), kVersion));
}

Vec3 read_direction(const json& owner, const char* key, PatientFrame frame) {
    return in_context(key, [&] {
        const Vec3 direction = to_lps(frame, to_vec3(member(owner, key)));
        const Vec3 unit = normalized(direction);
        if (!(std::abs(norm(unit) - 1) < 1e-9))
            corrupt(fmt::format("has length {:g}, which gives no direction", norm(direction)));
        // Keep what is already a unit vector to the last bit: then writing and reading changes nothing.
        return std::abs(norm(direction) - 1) < 1e-12 ? direction : unit;
    });
}

/// `u` and `v` turned by less than a rounding error so that they stand on the normal and on each other.
void make_orthonormal(Plane& plane) {
    constexpr double kLimit = 1e-3, kExact = 1e-12;
    const double skew = std::max(
        {std::abs(dot(plane.normal, plane.u)), std::abs(dot(plane.normal, plane.v)), std::abs(dot(plane.u, plane.v))});
    if (skew < kExact) return;
    if (!(skew <= kLimit))
        corrupt(fmt::format("normal, u and v are not perpendicular: a cosine is {:.3g}; the limit is {:g}", skew, kLimit));
    plane.u = normalized(plane.u - dot(plane.u, plane.normal) * plane.normal);
    const Vec3 right_handed = cross(plane.normal, plane.u);
    plane.v = dot(right_handed, plane.v) > 0 ? right_handed : -right_handed;
}

Plane read_plane(const json& item, PatientFrame frame) {
    const Vec3 origin = in_context("origin", [&] { return to_lps(frame, to_vec3(member(item, "origin"))); });
    const Vec3 normal = read_direction(item, "normal", frame);
    Plane plane = make_plane(origin, normal);
    plane.normal = normal;  // make_plane may have rounded it once more
    if (item.contains("v") && !item.contains("u")) corrupt("has 'v' without 'u'");
    if (!item.contains("u")) return plane;
    plane.u = read_direction(item, "u", frame);
    plane.v = item.contains("v") ? read_direction(item, "v", frame) : cross(plane.normal, plane.u);
    make_orthonormal(plane);
    return plane;
}

std::vector<Vec3> read_points(const json& array, PatientFrame frame) {
    std::vector<Vec3> points;
    points.reserve(array.size());
    for_each_item(array, "point", [&](const json& item) { points.push_back(to_lps(frame, to_vec3(item))); });
    return points;
}

/// One of the values of an enumeration by its name, nothing where the key is absent.
template <class Value>
std::optional<Value> named_member(const json& item, const char* key, std::initializer_list<Value> values) {
    if (!item.contains(key)) return std::nullopt;
    const std::string text = text_member(item, key, "");
    std::string known;
    for (const Value value : values) {
        if (text == name(value)) return value;
        known += fmt::format("{}\"{}\"", known.empty() ? "" : " or ", name(value));
    }
    corrupt(fmt::format("'{}' is \"{}\"; {} is expected", key, text, known));
}

std::optional<double> optional_number(const json& owner, const char* key) {
    return owner.contains(key) ? std::optional(number_member(owner, key, 0)) : std::nullopt;
}

Contour read_contour(const json& item, const Plane& plane, PatientFrame frame) {
    Contour contour{plane, read_points(array_member(item, "points"), frame), flag_member(item, "closed", true),
                    flag_member(item, "hole", false)};
    contour.end = named_member(item, "end", {ContourEnd::flat, ContourEnd::round}).value_or(ContourEnd::automatic);
    contour.inside = named_member(item, "inside", {Hand::left, Hand::right});
    contour.weight = number_member(item, "weight", 1);
    contour.frame = optional_number(item, "frame");
    contour.time_s = optional_number(item, "time_s");
    std::vector<Vec3>& points = contour.points;
    if (contour.closed && points.size() > 1 && points.back() == points.front()) points.pop_back();
    return contour;
}

/// Either [x, y, z] or {"point": [x, y, z], "outward": [x, y, z]}.
SurfacePoint read_surface_point(const json& item, PatientFrame frame) {
    if (item.is_array()) return {to_lps(frame, to_vec3(item)), {}};
    SurfacePoint point{in_context("point", [&] { return to_lps(frame, to_vec3(member(item, "point"))); }), {}};
    if (item.contains("outward")) point.outward = read_direction(item, "outward", frame);
    return point;
}

std::vector<SurfacePoint> read_surface(const json& document) {
    std::vector<SurfacePoint> points;
    if (!document.contains("surface")) return points;
    const PatientFrame frame = read_frame(document);
    in_context("surface", [&] {
        for_each_item(array_member(document, "surface"), "point",
                      [&](const json& item) { points.push_back(read_surface_point(item, frame)); });
    });
    return points;
}

/// Calls `body(item, plane, frame)` for every plane of a file.
template <class Body>
void for_each_plane(const json& document, Body body) {
    check_version(document);
    const PatientFrame frame = read_frame(document);
    for_each_item(array_member(document, "planes"), "plane",
                  [&](const json& item) { body(item, read_plane(item, frame), frame); });
}

std::vector<Vec3> read_constraints(const json& document, const char* key) {
    if (!document.contains(key)) return {};
    return in_context(key, [&] { return read_points(array_member(document, key), read_frame(document)); });
}

/// The planes under a key, in which nothing can be drawn.
std::vector<Plane> read_bare_planes(const json& document, const char* key, const char* if_drawn) {
    std::vector<Plane> planes;
    if (!document.contains(key)) return planes;
    const PatientFrame frame = read_frame(document);
    in_context(key, [&] {
        for_each_item(array_member(document, key), "plane", [&](const json& item) {
            if (item.contains("contours") && !array_member(item, "contours").empty()) corrupt(if_drawn);
            planes.push_back(read_plane(item, frame));
        });
    });
    return planes;
}

ContourSet read_set(const json& document) {
    ContourSet set;
    for_each_plane(document, [&](const json& item, const Plane& plane, PatientFrame frame) {
        if (!item.contains("contours")) return;
        for_each_item(array_member(item, "contours"), "contour",
                      [&](const json& contour) { set.contours.push_back(read_contour(contour, plane, frame)); });
    });
    set.name = text_member(document, "structure", "");
    set.attributes = read_attributes(document);
    set.interior = read_constraints(document, "interior");
    set.exterior = read_constraints(document, "exterior");
    set.surface = read_surface(document);
    set.empty_planes = read_bare_planes(document, "empty_planes", "has contours; nothing was drawn in an empty plane");
    set.cycle_frames = optional_number(document, "cycle_frames");
    set.cycle_s = optional_number(document, "cycle_s");
    return set;
}

std::vector<Plane> planes_of(const json& document) {
    std::vector<Plane> planes;
    for_each_plane(document, [&](const json&, const Plane& plane, PatientFrame) { planes.push_back(plane); });
    return planes;
}

std::vector<Plane> confirmed_planes_of(const json& document) {
    return read_bare_planes(document, "confirmed_planes", "has contours; a plane that was drawn in is corrected");
}

/// Each number is the shortest decimal that reads back as the same double; adding 0 turns -0, which JSON readers lose, to 0.
std::string to_text(const Vec3& v) {
    if (!is_finite(v)) throw Error(ErrorKind::invalid_input, "a coordinate to be written is NaN or infinite");
    return fmt::format("[{}, {}, {}]", v.x + 0.0, v.y + 0.0, v.z + 0.0);
}

std::string to_text(const SurfacePoint& p) {
    if (!p.outward) return to_text(p.position);
    return fmt::format("{{\"point\": {}, \"outward\": {}}}", to_text(p.position), to_text(*p.outward));
}

std::string members_of(const Plane& plane) {
    return fmt::format("\"origin\": {}, \"normal\": {}, \"u\": {}, \"v\": {}", to_text(plane.origin), to_text(plane.normal),
                       to_text(plane.u), to_text(plane.v));
}

std::string plane_head(const Plane& plane) { return fmt::format("  {{{}, \"contours\": [\n", members_of(plane)); }

std::string to_text(const Plane& plane) { return fmt::format("{{{}}}", members_of(plane)); }

template <class Point>
std::string to_text(const std::vector<Point>& points) {
    std::string text = "[";
    for (const Point& p : points) {
        if (text.size() > 1) text += ", ";
        text += to_text(p);
    }
    return text + "]";
}

std::string to_member(const char* key, double value) {
    if (!std::isfinite(value))
        throw Error(ErrorKind::invalid_input, fmt::format("{} to be written is NaN or infinite", key));
    return fmt::format("\"{}\": {}", key, value + 0.0);
}

std::string to_text(const Contour& contour) {
    std::string text = fmt::format("    {{\"closed\": {}, \"hole\": {}, ", contour.closed, contour.hole);
    if (contour.end != ContourEnd::automatic) text += fmt::format("\"end\": \"{}\", ", name(contour.end));
    if (contour.inside) text += fmt::format("\"inside\": \"{}\", ", name(*contour.inside));
    if (!std::isfinite(contour.weight)) throw Error(ErrorKind::invalid_input, "a contour's weight is NaN or infinite");
    if (contour.weight != 1) text += fmt::format("\"weight\": {}, ", contour.weight);
    if (contour.frame) text += to_member("frame", *contour.frame) + ", ";
    if (contour.time_s) text += to_member("time_s", *contour.time_s) + ", ";
    return text + fmt::format("\"points\": {}}}", to_text(contour.points));
}

std::string planes_text(const std::vector<Contour>& contours) {
    std::string text;
    for (std::size_t i = 0; i < contours.size(); ++i) {
        const bool same_plane = i > 0 && contours[i].plane == contours[i - 1].plane;
        if (same_plane) text += ",\n";
        else text += (i > 0 ? "\n  ]},\n" : "") + plane_head(contours[i].plane);
        text += to_text(contours[i]);
    }
    return contours.empty() ? text : text + "\n  ]}\n";
}

std::string members_of(const StructureAttributes& attributes) {
    const nlohmann::ordered_json members = attribute_members(attributes);
    std::string text;
    for (const auto& [key, value] : members.items()) text += fmt::format(",\n\"{}\": {}", key, value.dump());
    return text;
}

/// The document up to its planes' end; `more` members follow the name.
std::string document_of(const std::string& name, const std::string& more, const std::string& planes) {
    return fmt::format("{{\n\"version\": {},\n\"frame\": \"LPS mm\",\n\"structure\": {}{},\n\"planes\": [\n{}]", kVersion,
                       json(name).dump(), more, planes);
}

std::string to_document(const ContourSet& set, const Provenance& provenance, const std::vector<Plane>& confirmed) {
    check_utf8(set.name, "the structure's name");
    std::string text = document_of(set.name, members_of(set.attributes), planes_text(set.contours));
    if (!set.interior.empty()) text += ",\n\"interior\": " + to_text(set.interior);
    if (!set.exterior.empty()) text += ",\n\"exterior\": " + to_text(set.exterior);
    if (!set.surface.empty()) text += ",\n\"surface\": " + to_text(set.surface);
    if (!set.empty_planes.empty()) text += ",\n\"empty_planes\": " + to_text(set.empty_planes);
    if (set.cycle_frames) text += ",\n" + to_member("cycle_frames", *set.cycle_frames);
    if (set.cycle_s) text += ",\n" + to_member("cycle_s", *set.cycle_s);
    if (!confirmed.empty()) text += ",\n\"confirmed_planes\": " + to_text(confirmed);
    if (!provenance.empty()) text += ",\n\"provenance\": " + to_json(provenance);
    return text + "\n}\n";
}

}  // namespace

ContourSet read_contour_json(const std::filesystem::path& path) {
    const json document = read_json_file(path);
    return in_context(path.string(), [&] { return read_set(document); });
}

ContourSet parse_contour_json(std::string_view text) { return read_set(parse_json(text)); }

std::vector<Plane> read_planes_json(const std::filesystem::path& path) {
    const json document = read_json_file(path);
    return in_context(path.string(), [&] { return planes_of(document); });
}

std::vector<Plane> parse_planes_json(std::string_view text) { return planes_of(parse_json(text)); }

std::vector<Plane> read_confirmed_planes_json(const std::filesystem::path& path) {
    const json document = read_json_file(path);
    return in_context(path.string(), [&] { return confirmed_planes_of(document); });
}

std::vector<Plane> parse_confirmed_planes_json(std::string_view text) { return confirmed_planes_of(parse_json(text)); }

void write_planes_json(const std::filesystem::path& path, const std::vector<Plane>& planes, const std::string& name) {
    check_utf8(name, "the structure's name");
    std::string text;
    for (const Plane& plane : planes) text += (text.empty() ? "" : ",\n") + plane_head(plane) + "  ]}";
    write_file_atomically(path, document_of(name, "", text + (planes.empty() ? "" : "\n")) + "\n}\n");
}

void write_contour_json(const std::filesystem::path& path, const ContourSet& set, const Provenance& provenance) {
    write_corrections_json(path, set, {}, provenance);
}

void write_corrections_json(const std::filesystem::path& path, const ContourSet& set, const std::vector<Plane>& confirmed,
                            const Provenance& provenance) {
    write_file_atomically(path, to_document(set, provenance, confirmed));
}

std::string to_contour_json(const ContourSet& set, const Provenance& provenance) { return to_document(set, provenance, {}); }

}  // namespace kontur
