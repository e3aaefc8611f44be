// SPDX-License-Identifier: Apache-2.0
#include "experiments.h"
#include "kontur/extract/voxelize.h"
#include "kontur/measure/compare.h"
#include "kontur/phantom/phantom.h"
#include "machine.h"
#include "published.h"
#include "runs.h"

namespace kontur::bench {
namespace {

struct Pipeline {
    const char* name;
    std::function<Segmentation()> run;
};

std::vector<Pipeline> pipelines(const PhantomCase& phantom) {
    return {{"default", [&] { return segment(phantom.contours, phantom.grid); }},
            {"default, tight",
             [&] {
                 SegmentOptions options;
                 options.tolerance_mm = 1e-4;
                 return segment(phantom.contours, phantom.grid, options);
             }},
            {"default, cholesky",
             [&] {
                 SegmentOptions options;
                 options.solver = Solver::cholesky;
                 options.voxelizer = Voxelizer::tracked;
                 return segment(phantom.contours, phantom.grid, options);
             }},
            {"paper, cholesky", [&] { return segment_as_published(phantom, Solver::cholesky); }},
            {"paper, dense", [&] { return segment_as_published(phantom, Solver::dense); }}};
}

}  // namespace

Json stages(const std::vector<std::pair<std::string, double>>& seconds) {
    Json object = Json::object();
    for (const auto& [stage, time] : seconds) object[stage] = time;
    return object;
}

Json end_to_end(const PhantomCase& phantom, int repeat) {
    const Mask truth = make_truth_mask(*phantom.body, phantom.grid);
    Json rows = Json::array();
    std::vector<Segmentation> by_default;  ///< by the iterative solver, also at a tight tolerance, and by Cholesky
    for (const Pipeline& pipeline : pipelines(phantom)) {
        const PeakMemory memory;
        const TimedSegmentation timed = segment_repeatedly(repeat, pipeline.run);
        const double peak_mb = memory.added_mb();
        const SegmentReport& report = timed.segmentation.report;
        rows.push_back({{"case", phantom.name},
                        {"pipeline", pipeline.name},
                        {"centres", report.centres},
                        {"solves", report.solves},
                        {"iterations", report.iterations},
                        {"stages_s", stages(report.seconds)},
                        {"total_s", timed.timing.seconds},
                        {"cpu_s", timed.timing.cpu_seconds},
                        {"runs", timed.timing.runs},
                        {"peak_mb", peak_mb},
                        {"residual_max_mm", report.residual.max_mm},
                        {"dice_truth", compare(timed.segmentation.mask, truth).dice}});
        if (by_default.size() < 3) by_default.push_back(timed.segmentation);
    }
    // What both should be: the direct solution, computed at every voxel.
    const Mask exact = fill(sample_everywhere(by_default.back().function, phantom.grid, {.threads = 0}));
    for (std::size_t i = 0; i < by_default.size(); ++i)
        rows[i]["jaccard_exact"] = compare(by_default[i].mask, exact).jaccard;
    return rows;
}

}  // namespace kontur::bench
