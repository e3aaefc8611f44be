// SPDX-License-Identifier: Apache-2.0
// What JavaScript calls (package/src/kontur.ts). Text is UTF-8, requests and answers are JSON; an object is its address, 0
// where it failed, which kontur_error tells then.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kontur/editor.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/segment.h"
#include "kontur/segment_report.h"
#include "kontur/view/outline.h"
#include "requests.h"
#include "result.h"
#include "samples.h"

using namespace kontur;
using namespace kontur::wasm;

namespace {

using nlohmann::json;

std::vector<float> as_floats(const std::vector<Vec3>& vectors) {
    std::vector<float> floats;
    floats.reserve(3 * vectors.size());
    for (const Vec3& v : vectors)
        for (const double x : {v.x, v.y, v.z}) floats.push_back(static_cast<float>(x));
    return floats;
}

void take_mesh(Result& result, TriangleMesh mesh) {
    result.points = as_floats(mesh.points);
    result.normals = as_floats(mesh.normals);
    for (const auto& triangle : mesh.triangles)
        result.triangles.insert(result.triangles.end(), triangle.begin(), triangle.end());
    result.mesh = std::move(mesh);
}

Result* segmented(std::string_view text, const void* samples, std::string_view type) {
    const Request request = request_from(text);
    const Work work = told_work();
    const Image image = samples ? image_from(samples, type, request.grid) : Image{};
    Segmentation segmentation = segment(request.contours, request.grid, samples ? &image : nullptr, request.options, work);
    auto result = std::make_unique<Result>();
    result->about = {{"grid", to_json(request.grid)},
                     {"report", json::parse(to_json(segmentation.report,
                                                    provenance(request.contours, request.grid, segmentation.report)))}};
    result->voxels = std::move(segmentation.mask.values);
    if (segmentation.mesh) take_mesh(*result, std::move(*segmentation.mesh));
    result->function = segmentation.function;
    return result.release();
}

Result* edited(EditedSurface surface) {
    auto result = std::make_unique<Result>();
    result->about = {{"finished", surface.finished}, {"spacingMm", surface.spacing_mm}};
    take_mesh(*result, std::move(surface.mesh));
    result->function = surface.function;
    return result.release();
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

KONTUR_EXPORT(kontur_segment)
(const char* request, std::size_t length, const void* samples, const char* type, std::size_t type_length)->Result* {
    return or_error([&] { return segmented({request, length}, samples, {type, type_length}); });
}

KONTUR_EXPORT(kontur_new_editor)()->Editor* {
    return or_error([] { return std::make_unique<Editor>().release(); });
}
KONTUR_EXPORT(kontur_drop_editor)(Editor* editor)->void { delete editor; }

KONTUR_EXPORT(kontur_preview)(Editor* editor, const char* contours, std::size_t length)->Result* {
    return or_error([&] { return edited(editor->preview(parse_contour_json({contours, length}), {.threads = 1})); });
}
KONTUR_EXPORT(kontur_finish)(Editor* editor, const char* contours, std::size_t length)->Result* {
    return or_error([&] { return edited(editor->finish(parse_contour_json({contours, length}), told_work())); });
}

KONTUR_EXPORT(kontur_drop)(Result* result)->void { delete result; }

/// Of what was made, by `which`: its place and its length in bytes.
KONTUR_EXPORT(kontur_array)(Result* result, int which, std::uint32_t* place_and_bytes)->void {
    const auto tell = [&](const auto& array) {
        place_and_bytes[0] = reinterpret_cast<std::uint32_t>(array.data());
        place_and_bytes[1] = static_cast<std::uint32_t>(array.size() * sizeof(array[0]));
    };
    switch (which) {
        case 0:
            result->text = result->about.dump(-1, ' ', false, json::error_handler_t::replace);
            return tell(result->text);
        case 1:
            return tell(result->voxels);
        case 2:
            return tell(result->points);
        case 3:
            return tell(result->normals);
        default:
            return tell(result->triangles);
    }
}

/// f at points of three numbers each; 1 where it went well.
KONTUR_EXPORT(kontur_values)(const Result* result, const double* points, std::size_t count, double* values)->int {
    return or_error([&] {
        std::vector<Vec3> places;
        for (std::size_t n = 0; n < count; ++n) places.push_back({points[3 * n], points[3 * n + 1], points[3 * n + 2]});
        result->function.values(places, std::span(values, count), {.threads = 1});
        return 1;
    });
}

/// A mesh of anyone's, to be cut: points and triangles of three numbers each.
KONTUR_EXPORT(kontur_mesh)
(const float* points, std::size_t point_count, const std::uint32_t* triangles, std::size_t triangle_count)->Result* {
    return or_error([&] {
        TriangleMesh mesh;
        for (const float* p = points; p != points + 3 * point_count; p += 3) mesh.points.push_back({p[0], p[1], p[2]});
        for (const std::uint32_t* t = triangles; t != triangles + 3 * triangle_count; t += 3)
            mesh.triangles.push_back({t[0], t[1], t[2]});
        auto result = std::make_unique<Result>();
        result->mesh = std::move(mesh);
        return result.release();
    });
}

/// The mesh cut by a plane, as text of another object.
KONTUR_EXPORT(kontur_outline)(const Result* result, const char* plane, std::size_t length)->Result* {
    return or_error([&] {
        auto lines = std::make_unique<Result>();
        lines->about = as_json(outline(result->mesh, plane_from({plane, length})));
        return lines.release();
    });
}
