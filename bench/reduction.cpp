// SPDX-License-Identifier: Apache-2.0
#include "experiments.h"
#include "kontur/measure/compare.h"
#include "kontur/phantom/phantom.h"
#include "published.h"
#include "runs.h"

namespace kontur::bench {
namespace {

double stage(const SegmentReport& report, std::string_view name) {
    for (const auto& [stage, seconds] : report.seconds)
        if (stage == name) return seconds;
    return 0;
}

Json row(const PhantomCase& phantom, const char* configuration, const TimedSegmentation& timed, const Mask& full,
         const Mask& truth) {
    const SegmentReport& report = timed.segmentation.report;
    const Mask& mask = timed.segmentation.mask;
    return {{"case", phantom.name},
            {"configuration", configuration},
            {"quality", report.quality},
            {"centres", report.centres},
            {"iterations", report.iterations},
            {"fit_s", stage(report, "fit")},
            {"voxelize_s", stage(report, "voxelize")},
            {"total_s", timed.timing.seconds},
            {"cpu_s", timed.timing.cpu_seconds},
            {"runs", timed.timing.runs},
            {"jaccard", compare(mask, full).jaccard},
            {"dice_truth", compare(mask, truth).dice},
            {"residual_rms_mm", report.residual.rms_mm},
            {"residual_max_mm", report.residual.max_mm}};
}

}  // namespace

Json reduction(const PhantomCase& phantom, int repeat) {
    const Mask truth = make_truth_mask(*phantom.body, phantom.grid);
    Json rows = Json::array();
    for (const bool published : {true, false}) {
        Mask full;
        for (const double quality : {1.0, 0.5, 0.2, 0.1}) {
            const TimedSegmentation timed = segment_repeatedly(repeat, [&] {
                if (published) return segment_as_published(phantom, Solver::cholesky, quality);
                SegmentOptions options;
                options.quality = quality;
                return segment(phantom.contours, phantom.grid, options);
            });
            if (quality == 1.0) full = timed.segmentation.mask;
            rows.push_back(row(phantom, published ? "paper" : "default", timed, full, truth));
        }
    }
    return rows;
}

}  // namespace kontur::bench
