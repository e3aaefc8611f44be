// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/phantom.h"

#include <fmt/format.h>

#include <algorithm>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/phantom/anatomy.h"
#include "kontur/phantom/noise.h"

namespace kontur {
namespace {

bool overlap(const Box3& a, const Box3& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
    return true;
}

Box3 row_box(const Grid& grid, std::int64_t j, std::int64_t k) {
    Box3 box;
    box.extend(grid.center_mm(0, j, k));
    box.extend(grid.center_mm(grid.size.i - 1, j, k));
    return box;
}

class Painter {
public:
    Painter(const Grid& grid, const PhantomOptions& options)
        : grid_(grid),
          noise_(grid, options.seed, options.noise_hu),
          tissues_(abdominal_tissues()),
          edge_mm_(std::max(1.0, std::cbrt(grid.voxel_volume_mm3()))) {
        for (Tissue& tissue : tissues_) tissue.bounds = tissue.bounds.padded(edge_mm_);
    }

    void paint_row(std::int64_t j, std::int64_t k, std::int16_t* row) const {
        const Box3 box = row_box(grid_, j, k);
        std::vector<const Tissue*> tissues;
        for (const Tissue& tissue : tissues_)
            if (overlap(tissue.bounds, box)) tissues.push_back(&tissue);
        const std::vector<double> noise = noise_.row(j, k);
        for (std::int64_t i = 0; i < grid_.size.i; ++i) {
            const double hu = density(grid_.center_mm(i, j, k), tissues) + noise[static_cast<std::size_t>(i)];
            row[i] = static_cast<std::int16_t>(std::clamp(std::round(hu), -1024.0, 3071.0));
        }
    }

private:
    /// Each layer covers what lies below with the share of the voxel that it fills, taken from the depth of the centre.
    double density(const Vec3& p, const std::vector<const Tissue*>& tissues) const {
        double hu = kAirHu;
        for (const Tissue* tissue : tissues) {
            if (!tissue->bounds.contains(p)) continue;
            const double depth = tissue->depth(p);
            for (const Layer& layer : tissue->layers) {
                const double share = 0.5 + (depth - layer.from_mm) / edge_mm_;
                if (share <= 0) break;
                hu += std::min(share, 1.0) * (layer.hu - hu);
            }
        }
        return hu;
    }

    const Grid& grid_;
    CorrelatedNoise noise_;
    std::vector<Tissue> tissues_;
    double edge_mm_;
};

}  // namespace

Image make_phantom_image(const Grid& grid, const PhantomOptions& options, const Work& work) {
    check_grid(grid);
    if (!(options.noise_hu >= 0 && std::isfinite(options.noise_hu)))
        throw Error(ErrorKind::invalid_input, fmt::format("noise_hu is {:g}; it must be >= 0", options.noise_hu));
    const Painter painter(grid, options);
    std::vector<std::int16_t> samples(static_cast<std::size_t>(grid.voxel_count()));
    for (std::int64_t k = 0; k < grid.size.k; ++k) {
        work.report("phantom", static_cast<double>(k) / static_cast<double>(grid.size.k));
        parallel_for(grid.size.j, 8, work, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t j = begin; j < end; ++j) painter.paint_row(j, k, samples.data() + grid.offset(0, j, k));
        });
    }
    work.report("phantom", 1);
    return {grid, std::move(samples)};
}

Mask make_truth_mask(const Body& body, const Grid& grid, const Work& work) {
    check_grid(grid);
    Mask mask{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    parallel_for(grid.size.j * grid.size.k, 64, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const std::int64_t j = row % grid.size.j, k = row / grid.size.j;
            if (!overlap(body.bounds(), row_box(grid, j, k))) continue;
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                if (const Vec3 p = grid.center_mm(i, j, k); body.bounds().contains(p))
                    mask.values[grid.offset(i, j, k)] = body.value(p) > 0;
        }
    });
    return mask;
}

}  // namespace kontur
