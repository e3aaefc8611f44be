// SPDX-License-Identifier: Apache-2.0
#include "experiments.h"
#include "published.h"
#include "runs.h"

namespace kontur::bench {
namespace {

template <typename FindSurface>
Json row(const PhantomCase& phantom, const SegmentReport& fitted, Voxelizer voxelizer, int threads, int repeat,
         const FindSurface& find_surface) {
    std::int64_t evaluations = 0;
    std::size_t cells = 0;
    const Timing timing = measure(repeat, [&] {
        const SurfaceLattice surface = find_surface();
        fill(surface, threads);
        evaluations = surface.evaluations;
        cells = surface.cells.size();
    });
    return {{"case", phantom.name},         {"normals", name(fitted.normals)},
            {"centres", fitted.centres},    {"voxels", phantom.grid.voxel_count()},
            {"voxelizer", name(voxelizer)}, {"threads", threads},
            {"seconds", timing.seconds},    {"cpu_s", timing.cpu_seconds},
            {"runs", timing.runs},          {"evaluations", evaluations},
            {"surface_cells", cells}};
}

}  // namespace

Json voxelizing(const PhantomCase& phantom, int repeat) {
    const std::vector<Vec3> starts = drawn_points(phantom.contours);
    const int all_threads = thread_counts().back();
    Json rows = Json::array();
    for (const bool published : {true, false}) {
        const Segmentation fitted =
            published ? segment_as_published(phantom, Solver::cholesky) : segment(phantom.contours, phantom.grid);
        const ImplicitFunction& f = fitted.function;
        for (const int threads : thread_counts())
            rows.push_back(row(phantom, fitted.report, Voxelizer::tracked, threads, repeat,
                               [&] { return track_surface(f, phantom.grid, starts, threads); }));
        rows.push_back(row(phantom, fitted.report, Voxelizer::exhaustive, all_threads, 1,
                           [&] { return sample_everywhere(f, phantom.grid, all_threads); }));
    }
    return rows;
}

}  // namespace kontur::bench
