// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/view/outline.h"
#include "kontur/view/reslice.h"
#include "viewer/images/image_samples.h"
#include "viewer/model/binary_reply.h"
#include "viewer/model/message_checks.h"
#include "viewer/model/model_json.h"
#include "viewer/session/events.h"
#include "viewer/session/replies.h"

// What a view shows: the image on its plane, and where surfaces and contours meet it.

namespace kontur::viewer {
namespace {

using nlohmann::json;

// json's default constructor makes null, which cannot throw; clang-tidy sees the throwing cases of the one it calls.
struct SliceRequest {  // NOLINT(bugprone-exception-escape)
    std::string page, view;
    json plane;
    Reslice raster;
    int image = 0;  ///< its number
    std::optional<int> time{};
    Window window;
    enum class Pixels { none, least, shades, values } pixels;  ///< least: whichever of the two takes fewer bytes
    bool outlines;
};

SliceRequest::Pixels pixels_from(const Members& m) {
    if (m.has("pixels") && m.at("pixels") == "values") return SliceRequest::Pixels::values;
    if (m.has("pixels") && m.at("pixels") == "shades") return SliceRequest::Pixels::shades;
    return m.flag_or("pixels", true) ? SliceRequest::Pixels::least : SliceRequest::Pixels::none;
}

SliceRequest parse(std::string_view text) {
    const json document = parsed_request(text, "SliceRequest");
    const Members m(document);
    SliceRequest request;
    request.page = document.value("page", "");
    request.view = document.value("view", "");
    request.plane = m.at("plane");
    request.raster = {m.plane("plane"), document["width"].get<int>(), document["height"].get<int>(),
                      request.plane["mm_per_pixel"].get<double>()};
    request.image = m.image("image");
    request.time = m.time();
    request.pixels = pixels_from(m);
    request.outlines = m.flag_or("outlines", true);
    if (request.pixels == SliceRequest::Pixels::shades || request.pixels == SliceRequest::Pixels::least) {
        const Members window(m.at("window"));
        request.window = {window.number("center"), window.number("width")};
    }
    return request;
}

std::vector<std::uint8_t> shades(const Image& image, const SliceRequest& request) {
    const auto black = static_cast<float>(request.window.center - request.window.width);
    const std::vector<float> values = reslice(image, request.raster, black);
    // As `brightness`, but in one multiplication and addition: this runs for each pixel of each scroll step.
    const float scale = static_cast<float>(255 / request.window.width);
    const float shift = static_cast<float>(127.5 - request.window.center * 255 / request.window.width + 0.5);
    std::vector<std::uint8_t> pixels(values.size());
    std::transform(values.begin(), values.end(), pixels.begin(), [&](float v) {
        const float shade = v * scale + shift;
        return static_cast<std::uint8_t>(shade > 0 ? std::min(shade, 255.f) : 0.f);  // NaN is black
    });
    return pixels;
}

/// The image's values on a slice, in equal steps from its least to its largest: `first + step * (code - 1)`; 0 is outside of
/// the image, and what is not finite.
struct CodedValues {
    double first = 0, step = 0;
    std::vector<std::uint16_t> codes;
};

/// What of the image is sent: none, values of samples, or shades of the screen's pixels.
struct SentPixels {
    std::optional<ImageSamples> samples;
    bool shades = false;
};

SentPixels sent_pixels(const Grid& grid, const SliceRequest& request) {
    using Pixels = SliceRequest::Pixels;
    if (request.pixels == Pixels::none) return {};
    if (request.pixels == Pixels::shades) return {{}, true};
    const ImageSamples samples = samples_for(grid, request.raster);
    const bool takes_less = samples.pixels_per_sample() >= sizeof(std::uint16_t) / sizeof(std::uint8_t);
    if (request.pixels == Pixels::least && !takes_less) return {{}, true};
    return {samples};
}

json to_json(const ImageSamples& samples) {
    return {{"columns", samples.raster.width},
            {"rows", samples.raster.height},
            {"first", samples.first},
            {"step", samples.step}};
}

CodedValues coded_values(const Image& image, const Reslice& raster) {
    constexpr double kLargestCode = 65'535;
    const std::vector<float> values = reslice(image, raster, std::numeric_limits<float>::quiet_NaN());
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const float value : values)
        if (std::isfinite(value)) least = std::min<double>(least, value), most = std::max<double>(most, value);
    CodedValues coded;
    coded.codes.resize(values.size());
    if (!(least <= most)) return coded;
    coded.first = least;
    coded.step = (most - least) / (kLargestCode - 1);
    const double scale = coded.step > 0 ? 1 / coded.step : 0;
    std::transform(values.begin(), values.end(), coded.codes.begin(), [&](float value) {
        return static_cast<std::uint16_t>(std::isfinite(value) ? 1 + std::lround((value - least) * scale) : 0);
    });
    return coded;
}

/// Runs of points in pixels, column and row alternating.
class PixelPoints {
public:
    explicit PixelPoints(const Reslice& raster) : raster_(raster) {}

    json add(const std::vector<Vec3>& points) {
        const std::size_t first = numbers_.size() / 2;
        for (const Vec3& p : points)
            for (const double mm : raster_.plane.to_uv(p)) numbers_.push_back(static_cast<float>(mm / raster_.pixel_mm));
        return {{"first", first}, {"count", points.size()}};
    }
    std::span<const float> numbers() const { return numbers_; }

private:
    const Reslice& raster_;
    std::vector<float> numbers_;
};

/// To hundredths of a pixel, column and row alternating.
json in_pixels(const std::vector<std::vector<Vec3>>& lines, const Reslice& raster) {
    json runs = json::array();
    for (const std::vector<Vec3>& line : lines) {
        json& numbers = runs.emplace_back(json::array());
        for (const Vec3& p : line)
            for (const double mm : raster.plane.to_uv(p)) numbers.push_back(std::round(100 * mm / raster.pixel_mm) / 100);
    }
    return runs;
}

/// What of lines and points goes into a slice's reply.
struct SliceLines {
    const Reslice& raster;
    double thickness_mm;
    json& head;
    PixelPoints lines{raster}, dots{raster};
};

/// Lines of the visible surfaces; points of the visible contours of this time that cross the plane, names of those that lie
/// in it.
void add_outlines(const State& state, const std::map<Id, ShownSurface>& surfaces, int time, SliceLines& slice) {
    const Plane& plane = slice.raster.plane;
    const auto is_visible = [&](Id id) { return state.structures.contains(id) && state.structures.at(id).visible; };
    for (const auto& [id, surface] : surfaces) {
        if (!is_visible(id) || !surface.mesh) continue;
        const auto runs_of = [&](const TriangleMesh& mesh) {
            json runs = json::array();
            for (const Polyline& line : outline(mesh, plane)) {
                runs.push_back(slice.lines.add(line.points));
                runs.back()["closed"] = line.closed;
            }
            return runs;
        };
        json lines{{"structure", id}, {"revision", surface.revision}, {"lines", runs_of(*surface.mesh)}};
        if (surface.without_image) lines["without_image"] = runs_of(*surface.without_image);
        slice.head["outlines"].push_back(std::move(lines));
    }
    for (const auto& [id, contour] : state.contours) {
        if (!contour->visible || !is_visible(contour->structure) || time_of(state, *contour) != time) continue;
        if (lies_in(*contour, plane, slice.thickness_mm)) {
            slice.head["contours"].push_back(id);
            continue;
        }
        const std::vector<Vec3> points = crossings(as_contour(*contour), plane);
        if (points.empty()) continue;
        slice.head["crossings"].push_back(slice.dots.add(points));
        slice.head["crossings"].back()["contour"] = id;
    }
}

}  // namespace

json outlines_event(const std::vector<WatchedPlane>& all, Id structure, std::int64_t revision, const PlaneCutters& cut) {
    std::vector<WatchedPlane> watched;
    std::ranges::copy_if(all, std::back_inserter(watched),
                         [&](const WatchedPlane& plane) { return !cut.time || *cut.time == plane.time; });
    json views = json::array();
    for (const WatchedPlane& plane : watched) views.push_back({{"view", plane.view}, {"plane", plane.plane}});
    parallel_for(static_cast<std::int64_t>(watched.size()), 1, 0, [&](std::int64_t begin, std::int64_t end) {
        for (auto view = static_cast<std::size_t>(begin); view < static_cast<std::size_t>(end); ++view) {
            const Reslice& raster = watched[view].raster;
            views[view]["lines"] = in_pixels(cut.surface(raster.plane), raster);
            if (cut.without_image) views[view]["without_image"] = in_pixels(cut.without_image(raster.plane), raster);
        }
    });
    json event{{"event", "outlines"}, {"structure", structure}, {"revision", revision}, {"views", std::move(views)}};
    if (cut.time) event["time"] = *cut.time;
    return event;
}

std::string slice_reply(SessionState& s, std::string_view text) {
    const SliceRequest request = parse(text);
    const std::shared_ptr<const Image> image = image_numbered(s, request.image, request.time);
    const int time = request.time.value_or(s.image.times.own());
    if (request.outlines) {
        s.watched.set({request.page, request.view, request.raster, request.plane, time});
        s.surfaces.motions().look_at(time);
    }
    const EdgeLetters letters = edge_letters(request.raster.plane);
    json head{
        {"width", request.raster.width},
        {"height", request.raster.height},
        {"letters", {{"left", letters.left}, {"right", letters.right}, {"top", letters.top}, {"bottom", letters.bottom}}}};
    head["outlines"] = head["crossings"] = head["contours"] = json::array();
    SliceLines slice{request.raster, slice_step_mm(s.image.voxels->grid, request.raster.plane.normal), head};
    if (request.outlines) add_outlines(s.state(), s.surfaces.at(time), time, slice);
    if (!image) head["gone"] = true;
    const SentPixels sent = image ? sent_pixels(image->grid, request) : SentPixels{};
    CodedValues coded;
    if (sent.samples) {
        coded = coded_values(*image, sent.samples->raster);
        head["values"] = {{"first", coded.first}, {"step", coded.step}};
        head["samples"] = to_json(*sent.samples);
    }
    BinaryReply reply(std::move(head));
    reply.add("outline_points", slice.lines.numbers());
    reply.add("crossing_points", slice.dots.numbers());
    if (sent.samples) reply.add<std::uint16_t>("values", coded.codes);
    if (sent.shades) reply.add<std::uint8_t>("pixels", shades(*image, request));
    return reply.bytes();
}

}  // namespace kontur::viewer
