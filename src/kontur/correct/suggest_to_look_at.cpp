// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/suggest_to_look_at.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/correct/carried_walk.h"
#include "kontur/correct/change.h"
#include "kontur/image/intensities.h"
#include "kontur/image/local_looks.h"
#include "kontur/image/random_walk.h"
#include "kontur/sampling/place_in_turn.h"
#include "kontur/sureness/candidate_planes.h"

namespace kontur {
namespace {

constexpr double kBorderVoxels = 3;   ///< of the largest voxel side: what lies farther from the border is not doubted
constexpr double kLeastDoubt = 1e-3;  ///< of the first plane's doubtful area: planes with less are not worth a look

/// A voxel near the border, and how likely it is on the wrong side.
struct DoubtfulVoxel {
    Index3 at;  ///< in the mask's indices
    Vec3 position;
    double doubt;
};

/// The voxels of the mask near its border at which the image shows something, each as yet without a doubt.
std::vector<DoubtfulVoxel> border_voxels(const ExistingSurface& surface, const Intensities& intensities,
                                         std::vector<double>& values, const Work& work) {
    const Grid& grid = surface.grid();
    const IndexBox whole{{0, 0, 0}, {grid.size.i - 1, grid.size.j - 1, grid.size.k - 1}};
    const std::optional<IndexBox> box = common_box(surface.window_box(), whole);
    const double near = kBorderVoxels * largest(grid.spacing_mm());
    std::vector<DoubtfulVoxel> voxels;
    Index3 at;
    for (at.k = box->low.k; at.k <= box->high.k; ++at.k) {
        work.check();
        for (at.j = box->low.j; at.j <= box->high.j; ++at.j)
            for (at.i = box->low.i; at.i <= box->high.i; ++at.i) {
                if (std::abs(surface.value_at_voxel(at)) >= near) continue;
                const Vec3 position = grid.center_mm(at.i, at.j, at.k);
                const double value = intensities.at(position);
                if (!std::isfinite(value)) continue;
                voxels.push_back({at, position, 0});
                values.push_back(value);
            }
    }
    return voxels;
}

/// By what the image shows there, and how deep it lies.
void find_doubts(const ExistingSurface& surface, const std::vector<double>& values, std::vector<DoubtfulVoxel>& voxels,
                 const Work& work) {
    const IntensityScale scale(values);
    const double side = largest(surface.grid().spacing_mm()), share = kLookExamples / static_cast<double>(voxels.size());
    std::vector<LookExample> some;
    std::vector<Vec3> places;
    for (std::size_t n = 0; n < voxels.size(); ++n) {
        places.push_back(voxels[n].position);
        if (place_in_turn(voxels[n].at) < share)
            some.push_back({places.back(), static_cast<float>(scale(values[n])), surface.value_at_voxel(voxels[n].at) > 0});
    }
    const LocalLooks looks(std::move(some), kLooksReach * surface.radius_mm(), surface.grid(), places);
    parallel_for(static_cast<std::int64_t>(voxels.size()), 1 << 12, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
            const double f0 = surface.value_at_voxel(voxels[n].at);
            const double odds =
                kLogistic * f0 / side + looks.log_odds(voxels[n].position, static_cast<float>(scale(values[n])));
            voxels[n].doubt = 1 / (1 + std::exp(f0 > 0 ? odds : -odds));
        }
    });
}

/// Where planes of one direction are, as layers in which voxels are counted.
class Layers {
public:
    /// Of voxels across an axis of the grid.
    Layers(const Grid& grid, int axis) : grid_(&grid), axis_(axis), normal_(slice_normal(grid, axis)) {
        width_ = std::abs(dot(normal_, grid.index_to_mm.column(axis)));
        count_ = static_cast<std::size_t>(grid.size[axis]);
    }
    /// Between the extremes of voxels along a normal.
    Layers(const std::vector<DoubtfulVoxel>& voxels, const Vec3& normal, double width) : normal_(normal), width_(width) {
        double high = -std::numeric_limits<double>::infinity();
        low_ = -high;
        for (const DoubtfulVoxel& voxel : voxels) {
            low_ = std::min(low_, dot(voxel.position, normal));
            high = std::max(high, dot(voxel.position, normal));
        }
        count_ = static_cast<std::size_t>((high - low_) / width) + 1;
    }

    std::size_t count() const { return count_; }
    double width() const { return width_; }
    std::size_t of(const DoubtfulVoxel& voxel) const {
        if (axis_ >= 0) return static_cast<std::size_t>(voxel.at[axis_]);
        return std::min(static_cast<std::size_t>((dot(voxel.position, normal_) - low_) / width_), count_ - 1);
    }
    /// The plane through the middle of a layer, with its origin near a place.
    PlaneToLookAt plane(std::size_t layer, const Vec3& near, double doubtful_mm2) const {
        PlaneToLookAt found{{}, {}, doubtful_mm2};
        if (axis_ >= 0) {
            found.slice = ImageSlice{axis_, static_cast<std::int64_t>(layer)};
            found.plane = slice_plane(*grid_, *found.slice);
            found.plane.origin = near - found.plane.distance_to(near) * found.plane.normal;
            return found;
        }
        const double offset = low_ + (static_cast<double>(layer) + 0.5) * width_;
        found.plane = make_plane(near + (offset - dot(near, normal_)) * normal_, normal_);
        return found;
    }

private:
    const Grid* grid_ = nullptr;
    int axis_ = -1;  ///< -1: across none
    Vec3 normal_;
    double low_ = 0, width_ = 0;
    std::size_t count_ = 0;
};

std::vector<Layers> layers_of(const ExistingSurface& surface, const std::vector<DoubtfulVoxel>& voxels, PlaneChoice choice) {
    std::vector<Layers> all;
    for (int axis = 0; axis < 3; ++axis) all.emplace_back(surface.grid(), axis);
    if (choice == PlaneChoice::image_slices) return all;
    std::vector<Vec3> positions;
    for (const DoubtfulVoxel& voxel : voxels)
        if (place_in_turn(voxel.at) < kLookExamples / static_cast<double>(voxels.size()))
            positions.push_back(voxel.position);
    for (const PlaneStack& stack : candidate_planes(positions, PlaneChoice::any, std::nullopt))
        all.emplace_back(voxels, stack.normal, largest(surface.grid().spacing_mm()));
    return all;
}

/// Of one direction: the layer with the largest doubtful area.
PlaneToLookAt best_of(const Layers& layers, const std::vector<DoubtfulVoxel>& voxels, double voxel_mm3) {
    std::vector<double> sums(layers.count());
    for (const DoubtfulVoxel& voxel : voxels) sums[layers.of(voxel)] += voxel.doubt;
    const auto best = static_cast<std::size_t>(std::max_element(sums.begin(), sums.end()) - sums.begin());
    Vec3 middle;
    for (const DoubtfulVoxel& voxel : voxels)
        if (layers.of(voxel) == best) middle += voxel.doubt / sums[best] * voxel.position;
    return layers.plane(best, middle, sums[best] * voxel_mm3 / layers.width());
}

/// What was looked at tells of what is near, as far as corrections are carried.
void see(const Plane& plane, double length_mm, std::vector<DoubtfulVoxel>& voxels) {
    for (DoubtfulVoxel& voxel : voxels) voxel.doubt *= 1 - likeness(std::abs(plane.distance_to(voxel.position)), length_mm);
}

}  // namespace

std::vector<PlaneToLookAt> suggest_to_look_at(const ExistingSurface& surface, const Image& image, std::size_t count,
                                              const LookAtOptions& options, const Work& work) {
    if (count == 0) throw Error(ErrorKind::invalid_input, "0 planes are asked for; at least 1 is needed");
    check_image(image);
    std::vector<double> values;
    std::vector<DoubtfulVoxel> voxels = border_voxels(surface, Intensities(image), values, work);
    if (voxels.empty())
        throw Error(ErrorKind::invalid_input,
                    "the image shows nothing at the mask's border; give the image that was segmented");
    find_doubts(surface, values, voxels, work);
    const double length = correction_length_mm(surface);
    for (const Plane& plane : options.seen) see(plane, length, voxels);
    const std::vector<Layers> directions = layers_of(surface, voxels, options.planes);
    std::vector<PlaneToLookAt> found;
    while (found.size() < count) {
        std::vector<PlaneToLookAt> best(directions.size());
        parallel_for(static_cast<std::int64_t>(directions.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
            for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
                best[n] = best_of(directions[n], voxels, surface.grid().voxel_volume_mm3());
        });
        const auto next = std::max_element(best.begin(), best.end(), [](const PlaneToLookAt& a, const PlaneToLookAt& b) {
            return a.doubtful_mm2 < b.doubtful_mm2;
        });
        if (!(next->doubtful_mm2 > kLeastDoubt * (found.empty() ? 0 : found.front().doubtful_mm2))) break;
        found.push_back(*next);
        see(next->plane, length, voxels);
    }
    return found;
}

}  // namespace kontur
