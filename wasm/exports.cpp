// SPDX-License-Identifier: Apache-2.0
// What JavaScript calls (package/src/module.ts). Text is UTF-8, requests and answers are JSON; an object is its address, 0
// where it failed, which kontur_error tells then.
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/editor.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/phantom/cases.h"
#include "kontur/segment.h"
#include "kontur/segment_report.h"
#include "kontur/view/outline.h"
#include "requests.h"

#define KONTUR_EXPORT(name) extern "C" __attribute__((export_name(#name))) auto name

using namespace kontur;

/// Told how far a call is; not 0: it shall stop.
extern "C" __attribute__((import_module("kontur"), import_name("progress"))) int kontur_progress(const char* stage,
                                                                                                 std::size_t length,
                                                                                                 double fraction);

namespace {

using nlohmann::json;

std::string the_error;

/// Arrays of numbers as JavaScript takes them, and what else a call made.
struct Made {
    json about;  ///< answered as text
    std::string text{};
    std::vector<std::uint8_t> mask{};
    std::vector<float> points{}, normals{};
    std::vector<std::uint32_t> triangles{};
    TriangleMesh mesh{};
    ImplicitFunction function{};
};

void note_error(std::string_view kind, std::string_view message) {
    the_error = json{{"kind", kind}, {"message", message}}.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// 0 where `make` throws.
template <class Make>
auto or_error(const Make& make) -> decltype(make()) {
    try {
        return make();
    } catch (const Error& error) {
        note_error(name(error.kind()), error.what());
    } catch (const std::bad_alloc&) {
        note_error(name(ErrorKind::too_large), "it needs more memory than the 4 GB that WebAssembly can address");
    } catch (const std::exception& error) {
        note_error("internal", error.what());
    }
    return {};
}

Work told_work(const StopSource& stop) {
    return {.threads = 1,
            .callback =
                [stop](std::string_view stage, double fraction) {
                    if (kontur_progress(stage.data(), stage.size(), fraction) != 0) stop.request_stop();
                },
            .stop = stop.token()};
}

std::vector<float> as_floats(const std::vector<Vec3>& vectors) {
    std::vector<float> floats;
    floats.reserve(3 * vectors.size());
    for (const Vec3& v : vectors)
        for (const double x : {v.x, v.y, v.z}) floats.push_back(static_cast<float>(x));
    return floats;
}

void take_mesh(Made& made, TriangleMesh mesh) {
    made.points = as_floats(mesh.points);
    made.normals = as_floats(mesh.normals);
    for (const auto& triangle : mesh.triangles)
        made.triangles.insert(made.triangles.end(), triangle.begin(), triangle.end());
    made.mesh = std::move(mesh);
}

template <class Sample>
Image::Samples samples_at(const void* samples, const Grid& grid) {
    const auto* first = static_cast<const Sample*>(samples);
    return std::vector<Sample>(first, first + grid.voxel_count());
}

/// The types of typed arrays that an image may have.
Image image_from(const void* samples, std::string_view type, const Grid& grid) {
    if (type == "Uint8Array") return {grid, samples_at<std::uint8_t>(samples, grid)};
    if (type == "Int16Array") return {grid, samples_at<std::int16_t>(samples, grid)};
    if (type == "Uint16Array") return {grid, samples_at<std::uint16_t>(samples, grid)};
    if (type == "Int32Array") return {grid, samples_at<std::int32_t>(samples, grid)};
    if (type == "Float32Array") return {grid, samples_at<float>(samples, grid)};
    throw Error(ErrorKind::unsupported, "an image is a Uint8Array, Int16Array, Uint16Array, Int32Array or Float32Array");
}

Made* segmented(std::string_view text, const void* samples, std::string_view type) {
    const wasm::Request request = wasm::request_from(text);
    const Work work = told_work(StopSource{});
    const Image image = samples ? image_from(samples, type, request.grid) : Image{};
    Segmentation result = segment(request.contours, request.grid, samples ? &image : nullptr, request.options, work);
    auto made = std::make_unique<Made>();
    made->about = {
        {"grid", wasm::to_json(request.grid)},
        {"report", json::parse(to_json(result.report, provenance(request.contours, request.grid, result.report)))}};
    made->mask = std::move(result.mask.values);
    if (result.mesh) take_mesh(*made, std::move(*result.mesh));
    made->function = result.function;
    return made.release();
}

Made* edited(EditedSurface surface) {
    auto made = std::make_unique<Made>();
    made->about = {{"finished", surface.finished}, {"spacingMm", surface.spacing_mm}};
    take_mesh(*made, std::move(surface.mesh));
    made->function = surface.function;
    return made.release();
}

json as_json(const std::vector<Polyline>& lines) {
    json all = json::array();
    for (const Polyline& line : lines) {
        json points = json::array();
        for (const Vec3& p : line.points) points.insert(points.end(), {p.x, p.y, p.z});
        all.push_back({{"closed", line.closed}, {"points", std::move(points)}});
    }
    return all;
}

}  // namespace

KONTUR_EXPORT(kontur_allocate)(std::size_t bytes)->void* { return std::malloc(bytes); }
KONTUR_EXPORT(kontur_release)(void* place)->void { std::free(place); }

KONTUR_EXPORT(kontur_error)()->const char* { return the_error.c_str(); }

KONTUR_EXPORT(kontur_segment)
(const char* request, std::size_t length, const void* samples, const char* type, std::size_t type_length)->Made* {
    return or_error([&] { return segmented({request, length}, samples, {type, type_length}); });
}

KONTUR_EXPORT(kontur_new_editor)()->Editor* {
    return or_error([] { return std::make_unique<Editor>().release(); });
}
KONTUR_EXPORT(kontur_drop_editor)(Editor* editor)->void { delete editor; }

KONTUR_EXPORT(kontur_preview)(Editor* editor, const char* contours, std::size_t length)->Made* {
    return or_error([&] { return edited(editor->preview(parse_contour_json({contours, length}), {.threads = 1})); });
}
KONTUR_EXPORT(kontur_finish)(Editor* editor, const char* contours, std::size_t length)->Made* {
    return or_error([&] { return edited(editor->finish(parse_contour_json({contours, length}), told_work(StopSource{}))); });
}

/// Contours and grid of a case of the phantom.
KONTUR_EXPORT(kontur_phantom)(const char* name, std::size_t length)->Made* {
    return or_error([&] {
        const PhantomCase chosen = phantom_case({name, length});
        auto made = std::make_unique<Made>();
        made->about = {{"contours", json::parse(to_contour_json(chosen.contours))}, {"grid", wasm::to_json(chosen.grid)}};
        return made.release();
    });
}

KONTUR_EXPORT(kontur_drop)(Made* made)->void { delete made; }

/// Of what was made, by `which`: its place and its length in bytes.
KONTUR_EXPORT(kontur_array)(Made* made, int which, std::uint32_t* place_and_bytes)->void {
    const auto tell = [&](const auto& array) {
        place_and_bytes[0] = reinterpret_cast<std::uint32_t>(array.data());
        place_and_bytes[1] = static_cast<std::uint32_t>(array.size() * sizeof(array[0]));
    };
    switch (which) {
        case 0:
            made->text = made->about.dump(-1, ' ', false, json::error_handler_t::replace);
            return tell(made->text);
        case 1:
            return tell(made->mask);
        case 2:
            return tell(made->points);
        case 3:
            return tell(made->normals);
        default:
            return tell(made->triangles);
    }
}

/// f at points of three numbers each; 1 where it went well.
KONTUR_EXPORT(kontur_values)(const Made* made, const double* points, std::size_t count, double* values)->int {
    return or_error([&] {
        std::vector<Vec3> places;
        for (std::size_t n = 0; n < count; ++n) places.push_back({points[3 * n], points[3 * n + 1], points[3 * n + 2]});
        made->function.values(places, std::span(values, count), {.threads = 1});
        return 1;
    });
}

/// The mesh cut by a plane, as text of another object.
KONTUR_EXPORT(kontur_outline)(const Made* made, const char* plane, std::size_t length)->Made* {
    return or_error([&] {
        auto lines = std::make_unique<Made>();
        lines->about = as_json(outline(made->mesh, wasm::plane_from({plane, length})));
        return lines.release();
    });
}
