// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <vector>

#include "experiments.h"
#include "kontur/correct/existing_mesh.h"
#include "kontur/correct/mask_change.h"
#include "kontur/correct_mask.h"
#include "kontur/phantom/phantom.h"
#include "runs.h"

namespace kontur::bench {
namespace {

constexpr double kWider = 1.1;

/// The contour in the middle of the list, a tenth wider than the mask.
Corrections wider_outline(const ContourSet& set) {
    Contour contour = set.contours[set.contours.size() / 2];
    Vec3 middle;
    for (const Vec3& p : contour.points) middle += p / static_cast<double>(contour.points.size());
    for (Vec3& p : contour.points) p = middle + kWider * (p - middle);
    Corrections corrections;
    corrections.drawing.contours = {contour};
    return corrections;
}

Json row(const PhantomCase& phantom, const char* what, const Timing& timing) {
    return {{"case", phantom.name},
            {"what", what},
            {"voxels", phantom.grid.voxel_count()},
            {"seconds", timing.seconds},
            {"cpu_s", timing.cpu_seconds},
            {"runs", timing.runs}};
}

}  // namespace

Json correcting(const PhantomCase& phantom, int repeat) {
    const Mask mask = make_truth_mask(*phantom.body, phantom.grid);
    const Corrections corrections = wider_outline(phantom.contours);
    std::unique_ptr<ExistingSurface> surface;
    std::unique_ptr<ExistingMesh> existing;
    const Timing opened = measure(repeat, [&] {
        existing.reset();
        surface = std::make_unique<ExistingSurface>(mask);
        existing = std::make_unique<ExistingMesh>(*surface);
    });
    const Timing edited = measure(repeat, [&] {
        const MaskChange change = mask_change({mask, *surface}, corrections, {});
        existing->corrected(change.lattice.get(), change.voxels);
    });
    const Timing anew = measure(repeat, [&] {
        const CorrectedMask corrected = correct(mask, corrections);
        const ExistingSurface corrected_surface(corrected.mask);
        ExistingMesh(corrected_surface).mesh();
    });
    return Json::array({row(phantom, "opened", opened), row(phantom, "edited", edited), row(phantom, "anew", anew)});
}

}  // namespace kontur::bench
