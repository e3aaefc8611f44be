// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/carried_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kontur/base/parallel.h"
#include "kontur/correct/change.h"
#include "kontur/correct/change_lattice.h"
#include "kontur/correct/corrected_voxels.h"
#include "kontur/image/intensities.h"
#include "kontur/image/local_looks.h"
#include "kontur/image/random_walk.h"
#include "kontur/sampling/place_in_turn.h"

namespace kontur {
namespace {

constexpr double kDeviation = 0.7;        // of the correction carried farther: standard deviation of what is right ...
constexpr double kDeviationLength = 0.7;  // ... which rises with the distance from moved places over so many lengths
constexpr double kBand = 2.5;             // standard deviations: beyond, f0 + g is sure
constexpr double kLeastAsked = 0.15;      // of the smallest voxel side: where less is carried nothing is asked
constexpr double kLeastDeviation = 0.05;  // of the smallest voxel side
constexpr double kLooksWeight = 2;
constexpr double kTie = 1;  // of a voxel to what is known of it alone, beside its steps
constexpr double kTolerance = 1e-3;
constexpr double kExampleVoxels = 3;   // examples: up to so many of the largest voxel side from the surface ...
constexpr double kExampleMoves = 1.5;  // ... or so many mean moves ...
constexpr double kExampleLengths = 4;  // ... and so many lengths from moved places
constexpr double kRounding = 1e-6;     // a plane between two layers of voxels is in both, however they are rounded

/// Calls visit(axis, side, voxel) for the up to six neighbours of a voxel; sides are 0 to 5.
template <class Visit>
void visit_neighbours(const Index3& size, std::size_t voxel, const Visit& visit) {
    const Index3 at = index_at(voxel, size);
    const std::array<std::int64_t, 3> strides{1, size.i, size.i * size.j};
    for (int axis = 0; axis < 3; ++axis) {
        const auto stride = static_cast<std::size_t>(strides[static_cast<std::size_t>(axis)]);
        if (at[axis] > 0) visit(axis, 2 * axis, voxel - stride);
        if (at[axis] + 1 < size[axis]) visit(axis, 2 * axis + 1, voxel + stride);
    }
}

SurfaceChange change_by(const MaskCorrection& correction, const std::vector<CorrectedSection>& sections, double farther,
                        const Work& work) {
    const CorrectionLengths lengths = correction_lengths(correction.surface, farther * correction.reach);
    return solve_change(correction.surface, correction_data(correction.surface, sections, correction.drawing, lengths),
                        lengths, work);
}

class Walker {
public:
    Walker(const MaskCorrection& correction, const std::vector<CorrectedSection>& sections, const CarriedBox& at,
           const Work& work)
        : correction_(correction),
          sections_(sections),
          at_(at),
          work_(work),
          size_(at.box.size()),
          spacing_(at.grid.spacing_mm()),
          near_(change_by(correction, sections, 1, work)),
          far_(change_by(correction, sections, kFartherWithImage, work)),
          number_(at.looks.size(), WalkPlace::kNowhere) {}

    CarriedVoxels walk() {
        find_values();
        mark_planes();
        find_asked();
        voxels_.walked.assign(voxels_.alone.begin(), voxels_.alone.end());
        if (asked_.empty()) return std::move(voxels_);
        work_.check();
        const LocalLooks looks = looks_of_planes();
        const std::vector<double> inside = walk_inside(places(looks), kTolerance, work_);
        for (std::size_t n = 0; n < asked_.size(); ++n) voxels_.walked[asked_[n]] = static_cast<float>(inside[n]);
        return std::move(voxels_);
    }

private:
    Vec3 center(std::size_t voxel) const {
        const Index3 v = index_at(voxel, size_);
        return at_.grid.center_mm(v.i, v.j, v.k);
    }

    /// f0 + g and what is carried farther, voxel by voxel.
    void find_values() {
        const double least = kLeastChangeVoxels * smallest(spacing_);
        const ChangeLattice near(correction_.surface, near_, at_.box, work_), far(correction_.surface, far_, at_.box, work_);
        const std::size_t count = at_.looks.size();
        f_.resize(count);
        carried_.resize(count);
        voxels_.alone.resize(count);
        parallel_for(static_cast<std::int64_t>(count), 1 << 14, work_, [&](std::int64_t begin, std::int64_t end) {
            for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
                const Index3 v = index_at(n, size_);
                const Index3 voxel{v.i + at_.box.low.i, v.j + at_.box.low.j, v.k + at_.box.low.k};
                const double f0 = correction_.surface.value_at_voxel(voxel), g = near_.is_zero() ? 0 : near.at(voxel);
                const double f = std::abs(g) < least ? f0 : f0 + g;
                f_[n] = static_cast<float>(f);
                carried_[n] = static_cast<float>(far_.is_zero() ? 0 : far.at(voxel));
                voxels_.alone[n] = f > 0;
            }
        });
    }

    /// What was drawn in slices of voxels holds there; all voxels in planes are known.
    void mark_planes() {
        known_.resize(at_.looks.size());
        const Grid& whole = correction_.mask.grid;
        for (const VoxelSide& drawn : drawn_voxels(sections_, whole, at_.box)) {
            const Index3 v = index_at(drawn.offset, whole.size);
            if (at_.box.contains(v))
                voxels_.alone[at_.grid.offset(v.i - at_.box.low.i, v.j - at_.box.low.j, v.k - at_.box.low.k)] = drawn.inside;
        }
        for (std::size_t n = 0; n < known_.size(); ++n) {
            const Vec3 p = center(n);
            known_[n] = std::any_of(sections_.begin(), sections_.end(), [&](const CorrectedSection& section) {
                return is_in_plane(section.plane, at_.grid, p);
            });
        }
    }

    /// Standard deviation of the right surface at a voxel, mm.
    double deviation(std::size_t voxel) const {
        const double apart = far_.distance_to_moved(center(voxel));
        return kDeviation * std::abs(static_cast<double>(carried_[voxel])) *
               (1 - likeness(apart, kDeviationLength * near_.length_mm()));
    }

    void find_asked() {
        if (near_.is_zero()) return;
        const double least = kLeastAsked * smallest(spacing_);
        const Mask& mask = correction_.mask;
        for (std::size_t n = 0; n < known_.size(); ++n) {
            if (known_[n] || std::abs(carried_[n]) < least || !std::isfinite(at_.looks[n])) continue;
            const Index3 v = index_at(n, size_);
            const bool before =
                mask.values[mask.grid.offset(v.i + at_.box.low.i, v.j + at_.box.low.j, v.k + at_.box.low.k)] != 0;
            if (before == (voxels_.alone[n] != 0) && std::abs(static_cast<double>(f_[n])) >= kBand * deviation(n)) continue;
            number_[n] = static_cast<std::int32_t>(asked_.size());
            asked_.push_back(n);
        }
    }

    LocalLooks looks_of_planes() const {
        const double near = std::max(kExampleVoxels * largest(spacing_), kExampleMoves * far_.mean_mm());
        std::vector<std::size_t> all;
        for (std::size_t n = 0; n < known_.size(); ++n)
            if (known_[n] && std::abs(static_cast<double>(f_[n])) < near && std::isfinite(at_.looks[n]) &&
                far_.distance_to_moved(center(n)) < kExampleLengths * near_.length_mm())
                all.push_back(n);
        const double share = kLookExamples / static_cast<double>(all.size());
        std::vector<LookExample> some;
        for (const std::size_t n : all)
            if (place_in_turn(index_at(n, size_)) < share) some.push_back({center(n), at_.looks[n], voxels_.alone[n] != 0});
        std::vector<Vec3> places;
        for (const std::size_t voxel : asked_) places.push_back(center(voxel));
        return {std::move(some), kLooksReach * correction_.surface.radius_mm(), at_.grid, places};
    }

    /// How likely a voxel is inside by its depth and its look alone.
    double likely(std::size_t voxel, const LocalLooks& looks) const {
        const double sd = std::max(deviation(voxel), kLeastDeviation * smallest(spacing_));
        const double odds =
            kLogistic * static_cast<double>(f_[voxel]) / sd + kLooksWeight * looks.log_odds(center(voxel), at_.looks[voxel]);
        return 1 / (1 + std::exp(-odds));
    }

    float step(std::size_t from, std::size_t to, int axis) const {
        const double apart = static_cast<double>(at_.looks[from] - at_.looks[to]),
                     side = smallest(spacing_) / spacing_[axis];
        const double alike = std::isfinite(apart) ? std::exp(-kLookContrast * apart * apart) : 0;
        return static_cast<float>((alike + kLeastStepWeight) * side * side);
    }

    std::vector<WalkPlace> places(const LocalLooks& looks) const {
        std::vector<WalkPlace> places(asked_.size());
        parallel_for(static_cast<std::int64_t>(asked_.size()), 1 << 12, work_, [&](std::int64_t begin, std::int64_t end) {
            for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
                const std::size_t voxel = asked_[n];
                WalkPlace& place = places[n];
                place.ends = kTie;
                place.ends_inside = kTie * likely(voxel, looks);
                visit_neighbours(size_, voxel, [&](int axis, int side, std::size_t next) {
                    const float weight = step(voxel, next, axis);
                    if (number_[next] != WalkPlace::kNowhere) {
                        place.next[static_cast<std::size_t>(side)] = number_[next];
                        place.weight[static_cast<std::size_t>(side)] = weight;
                        return;
                    }
                    place.ends += static_cast<double>(weight);
                    if (voxels_.alone[next]) place.ends_inside += static_cast<double>(weight);
                });
            }
        });
        return places;
    }

    const MaskCorrection& correction_;
    const std::vector<CorrectedSection>& sections_;
    const CarriedBox& at_;
    const Work& work_;
    Index3 size_;
    Vec3 spacing_;
    SurfaceChange near_, far_;
    std::vector<float> f_, carried_;  // f0 + g; the change carried farther
    std::vector<std::uint8_t> known_;
    std::vector<std::int32_t> number_;  // of each voxel among those asked
    std::vector<std::size_t> asked_;
    CarriedVoxels voxels_;
};

}  // namespace

bool is_in_plane(const Plane& plane, const Grid& grid, const Vec3& center) {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        reach += (0.5 + kRounding) * std::abs(dot(plane.normal, grid.index_to_mm.column(axis)));
    return std::abs(plane.distance_to(center)) <= reach;
}

std::vector<std::uint8_t> CarriedVoxels::followed(const Index3& size, double weight) const {
    std::vector<std::uint8_t> sides = alone;
    std::vector<std::size_t> seeds, front;
    for (std::size_t n = 0; n < alone.size(); ++n) {
        const double other = alone[n] ? 1 - static_cast<double>(walked[n]) : static_cast<double>(walked[n]);
        if (weight * other <= 0.5) continue;
        sides[n] = !alone[n];
        seeds.push_back(n);
    }
    std::vector<std::uint8_t> hangs(alone.size());
    for (const std::size_t n : seeds)
        visit_neighbours(size, n, [&](int, int, std::size_t next) {
            if (hangs[n] || sides[next] != sides[n] || alone[next] != sides[next]) return;
            hangs[n] = 1;
            front.push_back(n);
        });
    while (!front.empty()) {
        const std::size_t n = front.back();
        front.pop_back();
        visit_neighbours(size, n, [&](int, int, std::size_t next) {
            if (hangs[next] || sides[next] != sides[n] || alone[next] == sides[next]) return;
            hangs[next] = 1;
            front.push_back(next);
        });
    }
    for (const std::size_t n : seeds)
        if (!hangs[n]) sides[n] = alone[n];
    return sides;
}

std::optional<CarriedBox> carried_box(const MaskCorrection& correction, const Image& image, const Work& work) {
    const SurfaceChange far = change_by(correction, correction.sections, kFartherWithImage, work);
    if (far.is_zero()) return {};
    const Grid& whole = correction.mask.grid;
    const std::optional<IndexBox> reached = index_box(whole, far.box());
    const std::optional<IndexBox> box = reached ? common_box(*reached, correction.surface.window_box()) : std::nullopt;
    if (!box) return {};
    CarriedBox found{*box, grid_of(whole, *box)};
    const Intensities intensities(image);
    std::vector<double> values(static_cast<std::size_t>(found.grid.voxel_count()));
    const Index3 size = box->size();
    parallel_for(static_cast<std::int64_t>(values.size()), 1 << 14, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t n = begin; n < end; ++n) {
            const Index3 v = index_at(static_cast<std::size_t>(n), size);
            values[static_cast<std::size_t>(n)] = intensities.at(found.grid.center_mm(v.i, v.j, v.k));
        }
    });
    const IntensityScale scale(values);
    found.looks.resize(values.size());
    parallel_for(static_cast<std::int64_t>(values.size()), 1 << 14, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            found.looks[n] =
                std::isfinite(values[n]) ? static_cast<float>(scale(values[n])) : std::numeric_limits<float>::quiet_NaN();
    });
    return found;
}

CarriedVoxels walk_carried(const MaskCorrection& correction, const std::vector<CorrectedSection>& sections,
                           const CarriedBox& at, const Work& work) {
    return Walker(correction, sections, at, work).walk();
}

}  // namespace kontur
