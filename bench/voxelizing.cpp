// SPDX-License-Identifier: Apache-2.0
#include "experiments.h"
#include "kontur/extract/adaptive.h"
#include "kontur/extract/voxelize.h"
#include "kontur/measure/compare.h"
#include "published.h"
#include "runs.h"

namespace kontur::bench {
namespace {

struct Run {
    Json row;
    Mask mask;
};

struct Way {
    Voxelizer voxelizer;
    int threads, repeat;
};

template <typename FindSurface>
Run run(const PhantomCase& phantom, const SegmentReport& fitted, const Way& way, const FindSurface& find_surface) {
    const auto& [voxelizer, threads, repeat] = way;
    std::int64_t evaluations = 0;
    std::size_t cells = 0;
    Mask mask;
    const Timing timing = measure(repeat, [&] {
        const SurfaceLattice surface = find_surface();
        mask = fill(surface, {.threads = way.threads});
        evaluations = surface.evaluations;
        cells = surface.cells.size();
    });
    return {{{"case", phantom.name},
             {"normals", name(fitted.normals)},
             {"centres", fitted.centres},
             {"voxels", phantom.grid.voxel_count()},
             {"voxelizer", name(voxelizer)},
             {"threads", threads},
             {"seconds", timing.seconds},
             {"cpu_s", timing.cpu_seconds},
             {"runs", timing.runs},
             {"evaluations", evaluations},
             {"surface_cells", cells}},
            std::move(mask)};
}

/// Every way to voxelize the function; the last run evaluates every voxel.
std::vector<Run> runs_of(const PhantomCase& phantom, const Segmentation& fitted, int repeat) {
    const std::vector<Vec3> starts = drawn_points(phantom.contours);
    const ImplicitFunction& f = fitted.function;
    std::vector<Run> runs;
    for (const int threads : thread_counts())
        runs.push_back(run(phantom, fitted.report, {Voxelizer::tracked, threads, repeat},
                           [&] { return track_surface(f, phantom.grid, starts, {.threads = threads}); }));
    for (const int threads : thread_counts())
        runs.push_back(run(phantom, fitted.report, {Voxelizer::adaptive, threads, repeat},
                           [&] { return track_surface_adaptively(f, phantom.grid, starts, {.threads = threads}); }));
    const int all_threads = thread_counts().back();
    runs.push_back(run(phantom, fitted.report, {Voxelizer::exhaustive, all_threads, 1},
                       [&] { return sample_everywhere(f, phantom.grid, {.threads = all_threads}); }));
    return runs;
}

}  // namespace

Json voxelizing(const PhantomCase& phantom, int repeat) {
    Json rows = Json::array();
    for (const bool published : {true, false}) {
        std::vector<Run> runs = runs_of(
            phantom, published ? segment_as_published(phantom, Solver::cholesky) : segment(phantom.contours, phantom.grid),
            repeat);
        for (Run& run : runs) {
            run.row["jaccard_exhaustive"] = compare(run.mask, runs.back().mask).jaccard;
            rows.push_back(std::move(run.row));
        }
    }
    return rows;
}

}  // namespace kontur::bench
