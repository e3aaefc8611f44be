// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "experiments.h"
#include "kontur/editor.h"
#include "runs.h"

namespace kontur::bench {
namespace {

constexpr int kEdits = 24;

/// Its time, and that of its stages.
using Preview = std::pair<double, std::vector<std::pair<std::string, double>>>;

/// First-order distances of the mesh's points from the surface of the function, ascending.
std::vector<double> distances(const TriangleMesh& mesh, const ImplicitFunction& function) {
    std::vector<double> values(mesh.points.size());
    std::vector<Vec3> gradients(mesh.points.size());
    function.values_and_gradients(mesh.points, values, gradients);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::abs(values[i]) / std::max(norm(gradients[i]), 0.1);
    std::sort(values.begin(), values.end());
    return values;
}

}  // namespace

Json editing(const PhantomCase& phantom, int repeat) {
    Editor editor({.segment = {}, .preview_spacing_mm = 2, .finished_spacing_mm = 4});  // of that, only the function counts
    editor.preview(phantom.contours);
    std::vector<Preview> previews;
    std::vector<double> shares, largest;
    double cpu_s = 0;
    for (int edit = 1; edit <= (repeat == 1 ? 2 : kEdits); ++edit) {
        const ContourSet contours = dragged(phantom.contours, edit);
        EditedSurface preview;
        const Timing timing = measure(1, [&] { preview = editor.preview(contours); });
        previews.emplace_back(timing.seconds, preview.seconds);
        cpu_s += timing.cpu_seconds;
        if (edit % 6 != 2) continue;
        const std::vector<double> off = distances(preview.mesh, editor.finish(contours).function);
        const auto within = std::upper_bound(off.begin(), off.end(), 0.5) - off.begin();
        shares.push_back(static_cast<double>(within) / static_cast<double>(off.size()));
        largest.push_back(off.back());
    }
    std::sort(previews.begin(), previews.end());
    const auto rank = [&](double share) {
        return previews[static_cast<std::size_t>(share * static_cast<double>(previews.size() - 1))];
    };
    return Json::array({{{"case", phantom.name},
                         {"edits", previews.size()},
                         {"median_s", rank(0.5).first},
                         {"stages_s", stages(rank(0.5).second)},
                         {"rank_90_s", rank(0.9).first},
                         {"cpu_s", cpu_s / static_cast<double>(previews.size())},
                         {"within_half_mm", *std::min_element(shares.begin(), shares.end())},
                         {"largest_mm", *std::max_element(largest.begin(), largest.end())}}});
}

}  // namespace kontur::bench
