// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/outline.h"
#include "viewer/surfaces/surfaces.h"

namespace kontur::viewer {

PlaneCutters cutters(const Surface& surface) {
    const auto cutter = [](const std::shared_ptr<const TriangleMesh>& mesh) -> PlaneCutter {
        if (!mesh) return {};
        return [mesh](const Plane& plane) {
            std::vector<std::vector<Vec3>> lines;
            for (Polyline& line : outline(*mesh, plane))
                lines.push_back(std::move(line.points));  // of a closed mesh: closed
            return lines;
        };
    };
    return {cutter(surface.mesh), cutter(surface.without_image), surface.time};
}

std::string_view name(SurfaceStage stage) noexcept {
    switch (stage) {
        case SurfaceStage::outdated:
            return "outdated";
        case SurfaceStage::preview:
            return "preview";
        case SurfaceStage::asking:
            return "asking";
        case SurfaceStage::finished:
            return "finished";
        case SurfaceStage::none:
            break;
    }
    return "none";
}

}  // namespace kontur::viewer
