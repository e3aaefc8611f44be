// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "experiments.h"
#include "kontur/derive/body_outline.h"
#include "kontur/derive/derived_surfaces.h"
#include "kontur/editor.h"
#include "kontur/phantom/phantom.h"
#include "runs.h"

namespace kontur::bench {
namespace {

constexpr int kEdits = 24;
constexpr std::int64_t kPreviewVoxels = 100'000;  // as the page looks at
constexpr std::pair<const char*, const char*> kRules[] = {{"margin", "PTV = CTV + 5 mm"},
                                                          {"spared", "PTV = CTV + 5 mm - (Cord + 3 mm)"},
                                                          {"six lengths", "PTV = CTV + {5 mm, superior 8 mm}"},
                                                          {"cropped to the body", "PTV = crop(CTV + 5 mm, body(), 3 mm)"}};

struct Times {
    std::vector<double> seconds, cpu_seconds;
    void add(const Timing& timing) {
        seconds.push_back(timing.seconds);
        cpu_seconds.push_back(timing.cpu_seconds);
    }
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// A ball of 10 mm beside the body.
ShownStructure cord_beside(const TriangleMesh& body) {
    const Box3 box = bounding_box(body.points);
    TriangleMesh ball = body;
    for (Vec3& p : ball.points) {
        const Vec3 from_middle = p - box.center();
        p = Vec3{box.max.x, box.center().y, box.center().z} + from_middle * (10 / norm(from_middle));
    }
    return {"Cord", std::make_shared<const TriangleMesh>(std::move(ball))};
}

}  // namespace

Json deriving(const PhantomCase& phantom, int repeat) {
    const Image image = make_phantom_image(phantom.grid);
    const auto body = std::make_shared<const Mask>(body_outline(image, {}, {}));
    const DerivedSurfacesOptions options{image.grid, kPreviewVoxels, [&](const auto&) { return body; }};
    Editor editor;
    const EditedSurface first = editor.preview(phantom.contours);
    const ShownStructure cord = cord_beside(first.mesh);
    std::map<std::string, Times> times;
    for (int edit = 1; edit <= (repeat == 1 ? 2 : kEdits); ++edit) {
        const ContourSet contours = dragged(phantom.contours, edit);
        EditedSurface shown;
        times["preview"].add(measure(1, [&] { shown = editor.preview(contours); }));
        const std::vector<ShownStructure> structures{
            {"CTV", std::make_shared<const TriangleMesh>(shown.mesh), shown.function}, cord};
        for (const auto& [name, rule] : kRules) {
            const bool needs_cord = std::string(rule).find("Cord") != std::string::npos;
            times[name].add(measure(1, [&] {
                derived_surfaces(std::vector<std::string>{rule}, std::span(structures).first(needs_cord ? 2 : 1), options);
            }));
        }
    }
    const Times& alone = times["preview"];
    Json rows = Json::array();
    for (const auto& [name, its] : times)
        rows.push_back(
            {{"case", phantom.name},
             {"what", name},
             {"median_s", median(its.seconds)},
             {"cpu_s", median(its.cpu_seconds)},
             {"preview_and_this", name == "preview" ? 1 : 1 + median(its.cpu_seconds) / median(alone.cpu_seconds)}});
    return rows;
}

}  // namespace kontur::bench
