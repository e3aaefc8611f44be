// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours/markups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kontur/base/counted.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/json_file.h"
#include "kontur/io/geometry/patient_frame.h"
#include "kontur/io/geometry/uniform_spline.h"

namespace kontur {
namespace {

using nlohmann::json;

constexpr std::string_view kSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
    "markups-schema-v1.0.3.json#";
constexpr std::array<std::uint8_t, 3> kGivenToAll{255, 128, 128};  ///< colour of 3D Slicer's markups
constexpr std::string_view kHole = "hole", kInside = "inside", kOutside = "outside";
constexpr const char* kOwn = "kontur";     ///< the key of how a file was made
constexpr double kSplineTolerance = 1e-4;  ///< of the line from the spline, in units of the curve's extent

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

/// Others were begun, or are previews of where the pointer is.
bool is_placed(const json& control_point) { return text_member(control_point, "positionStatus", "defined") == "defined"; }

bool has_position(const json& control_point) { return is_placed(control_point) && control_point.contains("position"); }

struct ControlPoint {
    Vec3 position;  ///< mm, LPS
    std::string description;
};

std::vector<ControlPoint> read_control_points(const json& markup) {
    const PatientFrame frame = read_frame(markup);
    const double unit_mm = read_unit_mm(markup);
    std::vector<ControlPoint> points;
    for_each_item(array_member(markup, "controlPoints"), "control point", [&](const json& item) {
        if (has_position(item))
            points.push_back(
                {unit_mm * to_lps(frame, to_vec3(member(item, "position"))), text_member(item, "description", "")});
    });
    return points;
}

void check_planar(const std::vector<Vec3>& points, const Plane& plane, double tolerance_mm) {
    double off_plane = 0;
    for (const Vec3& p : points) off_plane = std::max(off_plane, std::abs(plane.distance_to(p)));
    if (!(off_plane <= tolerance_mm))
        refuse(ErrorKind::invalid_input,
               fmt::format("is not planar: points lie up to {:.6g} mm off the plane fitted to it; the "
                           "limit is {:g} mm; draw each curve in one slice",
                           off_plane, tolerance_mm));
}

/// In place of straight lines between the control points.
void follow_spline(Contour& curve, const std::function<void(double)>& on_spline) {
    const double tolerance_mm = kSplineTolerance * bounding_box(curve.points).diagonal();
    UniformSpline spline = uniform_spline(curve.points, curve.closed, tolerance_mm);
    if (!(spline.off_mm > 0)) return;
    curve.points = std::move(spline.points);
    for (Vec3& p : curve.points) p -= curve.plane.distance_to(p) * curve.plane.normal;
    if (on_spline) on_spline(spline.off_mm);
}

Contour read_curve(const json& markup, bool closed, const ReadMarkupsOptions& options) {
    const std::vector<ControlPoint> controls = read_control_points(markup);
    Contour contour;
    contour.closed = closed;
    for (const ControlPoint& control : controls) {
        contour.points.push_back(control.position);
        contour.hole = contour.hole || (closed && control.description == kHole);
    }
    std::vector<Vec3>& points = contour.points;
    if (closed && points.size() > 1 && points.back() == points.front()) points.pop_back();
    const std::size_t least = closed ? 3 : 2;
    if (points.size() < least)
        refuse(ErrorKind::invalid_input,
               fmt::format("has {} with a position; at least {} are needed", counted(points.size(), "point"), least));
    if (const std::optional<Plane> plane = fit_plane(points)) {
        check_planar(points, *plane, options.plane_tolerance_mm);
        contour.plane = *plane;
        if (options.curves == Curves::spline) follow_spline(contour, options.on_spline);
    } else if (closed) {
        refuse(ErrorKind::invalid_input, fmt::format("its {} points lie on one line", points.size()));
    } else {
        contour.plane.normal = {};  // to be taken from another curve
    }
    return contour;
}

/// Gives a straight curve a plane parallel to another curve's.
void find_plane(Contour& straight, const std::vector<Contour>& contours, double tolerance_mm) {
    for (const Contour& other : contours) {
        if (other.plane.normal == Vec3{}) continue;
        Plane plane = other.plane;
        plane.origin = straight.points.front();
        if (std::ranges::all_of(straight.points,
                                [&](const Vec3& p) { return std::abs(plane.distance_to(p)) <= tolerance_mm; })) {
            straight.plane = plane;
            return;
        }
    }
    refuse(ErrorKind::invalid_input,
           fmt::format("its {} points lie on one line, and no other curve tells in which plane", straight.points.size()));
}

void append_points(const json& markup, ContourSet& set) {
    for (const ControlPoint& control : read_control_points(markup)) {
        if (control.description == kInside) set.interior.push_back(control.position);
        else if (control.description == kOutside) set.exterior.push_back(control.position);
        else set.surface.push_back({control.position});
    }
}

bool is_curve(const std::string& type) { return type == "ClosedCurve" || type == "Curve"; }

/// One that was begun, and of which no point was placed.
bool is_empty_curve(const json& markup) {
    return is_curve(text_member(markup, "type", "")) &&
           std::ranges::none_of(array_member(markup, "controlPoints"), is_placed);
}

void append_markup(const json& markup, const ReadMarkupsOptions& options, ContourSet& set) {
    const std::string type = text_member(markup, "type", "");
    if (type == "Fiducial") append_points(markup, set);
    else if (is_curve(type)) set.contours.push_back(read_curve(markup, type == "ClosedCurve", options));
    else
        refuse(ErrorKind::unsupported,
               "is a markup of type \"" + type +
                   "\"; closed and open curves and point lists are supported; save the others in a file of their own");
}

/// In which 3D Slicer shows the markup, whose points are selected until someone chooses. The one that it gives to all
/// markups was not chosen for this structure.
std::optional<std::array<std::uint8_t, 3>> read_color(const json& markup) {
    const json display = markup.value("display", json::object());
    if (!display.is_object()) return std::nullopt;
    const json levels = display.value("selectedColor", display.value("color", json()));
    if (!levels.is_array() || levels.size() != 3) return std::nullopt;
    for (const json& level : levels)
        if (!level.is_number() || !(level >= 0) || !(level <= 1)) return std::nullopt;
    const std::array<std::uint8_t, 3> color = to_rgb8(levels.get<std::array<double, 3>>());
    if (color == kGivenToAll) return std::nullopt;
    return color;
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

ContourSet read_set(const json& document, ReadMarkupsOptions options) {
    const json& markups = array_member(document, "markups");
    if (document.contains(kOwn)) options.curves = Curves::polygon;
    check_schema(document);
    ContourSet set;
    std::vector<std::string> names;
    std::size_t empty = 0;
    for_each_item(markups, "markup", [&](const json& markup) {
        if (is_empty_curve(markup)) {
            ++empty;
            return;
        }
        const std::size_t before = set.contours.size();
        append_markup(markup, options, set);
        if (!set.attributes.color) set.attributes.color = read_color(markup);
        if (set.contours.size() > before) names.push_back(text_member(markup, "name", ""));
    });
    if (empty > 0 && options.on_note) options.on_note(fmt::format("left out {} without a point", counted(empty, "curve")));
    for (std::size_t c = 0; c < set.contours.size(); ++c)
        if (set.contours[c].plane.normal == Vec3{})
            in_context(fmt::format("curve {}", c + 1),
                       [&] { find_plane(set.contours[c], set.contours, options.plane_tolerance_mm); });
    set.name = common_name(names);
    return set;
}

void check_writable(const ContourSet& set) {
    check_utf8(set.name, "the structure's name");
    const auto is_written = [](const std::vector<Vec3>& points) { return std::ranges::all_of(points, is_finite); };
    for (std::size_t i = 0; i < set.contours.size(); ++i)
        if (!is_written(set.contours[i].points))
            refuse(ErrorKind::invalid_input, fmt::format("contour {} has a NaN or infinite coordinate", i + 1));
    if (!is_written(set.interior) || !is_written(set.exterior) ||
        !std::ranges::all_of(set.surface, [](const SurfacePoint& p) { return is_finite(p.position); }))
        refuse(ErrorKind::invalid_input, "a single point has a NaN or infinite coordinate");
}

/// 3D Slicer refuses whole numbers without a decimal point in positions; the JSON library always writes it for doubles.
std::string to_text(const std::vector<ControlPoint>& points) {
    std::string text;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3& p = points[i].position;
        text += fmt::format(
            "{}\n    {{\"id\": \"{}\", \"label\": \"\", \"description\": \"{}\", \"position\": {}, "
            "\"positionStatus\": \"defined\"}}",
            i == 0 ? "" : ",", i + 1, points[i].description, json::array({p.x, p.y, p.z}).dump());
    }
    return text;
}

std::vector<ControlPoint> controls_of(const Contour& contour) {
    std::vector<ControlPoint> controls;
    for (const Vec3& p : contour.points) controls.push_back({p, std::string(contour.hole ? kHole : "")});
    return controls;
}

std::vector<ControlPoint> single_points_of(const ContourSet& set) {
    std::vector<ControlPoint> controls;
    for (const SurfacePoint& p : set.surface) controls.push_back({p.position, ""});
    for (const Vec3& p : set.interior) controls.push_back({p, std::string(kInside)});
    for (const Vec3& p : set.exterior) controls.push_back({p, std::string(kOutside)});
    return controls;
}

/// Levels from 0 to 1. Both keys: 3D Slicer shows points, and the curves through them, as selected until someone chooses.
std::string display_member(const std::optional<std::array<std::uint8_t, 3>>& color) {
    if (!color) return "";
    const auto [red, green, blue] = to_levels(*color);
    const std::string levels = fmt::format("[{:.6f}, {:.6f}, {:.6f}]", red, green, blue);
    return fmt::format("\"display\": {{\"color\": {0}, \"selectedColor\": {0}}}, ", levels);
}

std::string name_member(const std::string& name) { return name.empty() ? "" : "\"name\": " + json(name).dump() + ", "; }

std::string to_text(std::string_view type, const std::string& name, const std::string& display,
                    const std::vector<ControlPoint>& controls) {
    return fmt::format(
        "\n  {{\"type\": \"{}\", {}\"coordinateSystem\": \"LPS\", \"coordinateUnits\": \"mm\", {}"
        "\"controlPoints\": [{}]}}",
        type, name_member(name), display, to_text(controls));
}

std::string to_document(const ContourSet& set, const Provenance& provenance) {
    std::vector<std::string> markups;
    const std::string display = display_member(set.attributes.color);
    for (std::size_t i = 0; i < set.contours.size(); ++i) {
        const bool alone = set.name.empty() || set.contours.size() == 1;
        markups.push_back(to_text(set.contours[i].closed ? "ClosedCurve" : "Curve",
                                  alone ? set.name : fmt::format("{} {}", set.name, i + 1), display,
                                  controls_of(set.contours[i])));
    }
    if (const auto points = single_points_of(set); !points.empty())
        markups.push_back(to_text("Fiducial", set.name.empty() ? "" : set.name + " points", display, points));
    return fmt::format("{{\"@schema\": \"{}\",\n \"{}\": {},\n \"markups\": [{}]}}\n", kSchema, kOwn, to_json(provenance),
                       fmt::join(markups, ","));
}

}  // namespace

ContourSet read_markups(const std::filesystem::path& path, const ReadMarkupsOptions& options) {
    check_tolerances({.plane_tolerance_mm = options.plane_tolerance_mm});
    const json document = read_json_file(path);
    return in_context(path.string(), [&] { return read_set(document, options); });
}

ContourSet parse_markups(std::string_view text, const ReadMarkupsOptions& options) {
    check_tolerances({.plane_tolerance_mm = options.plane_tolerance_mm});
    return read_set(parse_json(text), options);
}

void write_markups(const std::filesystem::path& path, const ContourSet& set, const Provenance& provenance) {
    check_writable(set);
    write_file_atomically(path, to_document(set, provenance));
}

}  // namespace kontur
