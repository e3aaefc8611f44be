// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/markups.h"

#include <algorithm>
#include <optional>

#include "kontur/io/atomic_file.h"
#include "kontur/io/json_file.h"
#include "kontur/io/patient_frame.h"

namespace kontur {
namespace {

using nlohmann::json;

constexpr std::string_view kSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
    "markups-schema-v1.0.3.json#";
constexpr std::string_view kHole = "hole";

[[noreturn]] void refuse(ErrorKind kind, const std::string& message) { throw Error(kind, message); }

void check_schema(const json& document) {
    const std::string schema = text_member(document, "@schema", "");
    if (schema.find("markups-schema-v1.") == std::string::npos)
        refuse(ErrorKind::unsupported, "the schema is \"" + schema + "\"; markups-schema-v1.* is supported");
}

/// Old files give the frame by its number in 3D Slicer's source.
PatientFrame read_frame(const json& markup) {
    if (!markup.contains("coordinateSystem")) return PatientFrame::lps;
    const json& frame = markup["coordinateSystem"];
    if (frame == "LPS" || frame == "1" || frame == 1) return PatientFrame::lps;
    if (frame == "RAS" || frame == "0" || frame == 0) return PatientFrame::ras;
    refuse(ErrorKind::unsupported, "the coordinate system is " + quoted(frame) + "; LPS and RAS are supported");
}

/// Millimetres per unit. The unit is a UCUM code, alone or as [code, scheme, meaning].
double read_unit_mm(const json& markup) {
    if (!markup.contains("coordinateUnits")) return 1;
    const json& units = markup["coordinateUnits"];
    const json& code = units.is_array() && !units.empty() ? units.front() : units;
    if (code == "mm") return 1;
    if (code == "um") return 1e-3;
    refuse(ErrorKind::unsupported, "the unit is " + quoted(code) + "; mm and um are supported");
}

bool has_position(const json& control_point) {
    return text_member(control_point, "positionStatus", "defined") == "defined" && control_point.contains("position");
}

std::vector<Vec3> read_points(const json& markup) {
    const PatientFrame frame = read_frame(markup);
    const double unit_mm = read_unit_mm(markup);
    std::vector<Vec3> points;
    for_each_item(array_member(markup, "controlPoints"), "control point", [&](const json& item) {
        if (has_position(item)) points.push_back(unit_mm * to_lps(frame, to_vec3(member(item, "position"))));
    });
    if (points.size() > 1 && points.back() == points.front()) points.pop_back();
    return points;
}

bool is_hole(const json& markup) {
    const json& points = array_member(markup, "controlPoints");
    return std::any_of(points.begin(), points.end(),
                       [](const json& p) { return text_member(p, "description", "") == kHole; });
}

Plane plane_of(const std::vector<Vec3>& points, double tolerance_mm) {
    if (points.size() < 3)
        refuse(ErrorKind::invalid_input, fmt::format("has {} points with a position; at least 3 are needed", points.size()));
    const std::optional<Plane> plane = fit_plane(points);
    if (!plane) refuse(ErrorKind::invalid_input, fmt::format("its {} points lie on one line", points.size()));
    double off_plane = 0;
    for (const Vec3& p : points) off_plane = std::max(off_plane, std::abs(plane->distance_to(p)));
    if (!(off_plane <= tolerance_mm))
        refuse(ErrorKind::invalid_input,
               fmt::format("is not planar: points lie up to {:.6g} mm off the plane fitted to it; the "
                           "limit is {:g} mm",
                           off_plane, tolerance_mm));
    return *plane;
}

Contour read_curve(const json& markup, const ReadMarkupsOptions& options) {
    const std::string type = text_member(markup, "type", "");
    if (type != "ClosedCurve")
        refuse(ErrorKind::unsupported, "is a markup of type \"" + type + "\"; only ClosedCurve is a contour");
    const std::vector<Vec3> points = read_points(markup);
    return {plane_of(points, options.plane_tolerance_mm), points, true, is_hole(markup)};
}

/// What several numbered names have in common: "liver 1", "liver 12" give "liver".
std::string common_name(const std::vector<std::string>& names) {
    if (names.empty()) return {};
    std::string common = names.front();
    for (const std::string& name : names)
        common.erase(std::mismatch(common.begin(), common.end(), name.begin(), name.end()).first, common.end());
    if (names.size() == 1) return common;
    const std::size_t end = common.find_last_not_of("0123456789");
    common.erase(end == std::string::npos ? 0 : end + 1);
    const std::size_t last = common.find_last_not_of(" _-");
    return common.substr(0, last == std::string::npos ? 0 : last + 1);
}

ContourSet read_set(const json& document, const ReadMarkupsOptions& options) {
    const json& markups = array_member(document, "markups");
    check_schema(document);
    ContourSet set;
    std::vector<std::string> names;
    for_each_item(markups, "markup", [&](const json& markup) {
        set.contours.push_back(read_curve(markup, options));
        names.push_back(text_member(markup, "name", ""));
    });
    set.name = common_name(names);
    return set;
}

void check_writable(const ContourSet& set) {
    if (!set.interior.empty() || !set.exterior.empty())
        refuse(ErrorKind::unsupported, "3D Slicer markups hold no interior and exterior points");
    for (std::size_t i = 0; i < set.contours.size(); ++i) {
        if (!set.contours[i].closed)
            refuse(ErrorKind::unsupported,
                   fmt::format("contour {} is open; 3D Slicer markups are written as closed curves", i + 1));
        for (const Vec3& p : set.contours[i].points)
            if (!is_finite(p))
                refuse(ErrorKind::invalid_input, fmt::format("contour {} has a NaN or infinite coordinate", i + 1));
    }
}

/// 3D Slicer refuses whole numbers without a decimal point in positions; the JSON library always writes it for doubles.
std::string to_text(const Contour& contour) {
    std::string text;
    for (std::size_t i = 0; i < contour.points.size(); ++i) {
        const Vec3& p = contour.points[i];
        text += fmt::format(
            "{}\n    {{\"id\": \"{}\", \"label\": \"\", \"description\": \"{}\", \"position\": {}, "
            "\"positionStatus\": \"defined\"}}",
            i == 0 ? "" : ",", i + 1, contour.hole ? kHole : "", json::array({p.x, p.y, p.z}).dump());
    }
    return text;
}

std::string name_member(const ContourSet& set, std::size_t index) {
    if (set.name.empty()) return {};
    const std::string name = set.contours.size() == 1 ? set.name : fmt::format("{} {}", set.name, index + 1);
    return "\"name\": " + json(name).dump(-1, ' ', false, json::error_handler_t::replace) + ", ";
}

std::string to_document(const ContourSet& set, const Provenance& provenance) {
    std::string curves;
    for (std::size_t i = 0; i < set.contours.size(); ++i)
        curves += fmt::format(
            "{}\n  {{\"type\": \"ClosedCurve\", {}\"coordinateSystem\": \"LPS\", \"coordinateUnits\": \"mm\", "
            "\"controlPoints\": [{}]}}",
            i == 0 ? "" : ",", name_member(set, i), to_text(set.contours[i]));
    const std::string made = provenance.empty() ? "" : fmt::format(" \"kontur\": {},\n", to_json(provenance));
    return fmt::format("{{\"@schema\": \"{}\",\n{} \"markups\": [{}]}}\n", kSchema, made, curves);
}

}  // namespace

ContourSet read_markups(const std::filesystem::path& path, const ReadMarkupsOptions& options) {
    const json document = read_json_file(path);
    return in_context(path.string(), [&] { return read_set(document, options); });
}

void write_markups(const std::filesystem::path& path, const ContourSet& set, const Provenance& provenance) {
    check_writable(set);
    write_file_atomically(path, to_document(set, provenance));
}

}  // namespace kontur
