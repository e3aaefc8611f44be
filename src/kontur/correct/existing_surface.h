// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/work.h"
#include "kontur/shape/index_box.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A mask as a function f0: its signed distance in mm, positive inside, smoothed over about a voxel so that slopes have no
/// steps. At every voxel centre f0 has the mask's sign.
class ExistingSurface {
public:
    /// Throws as check_mask does, and Error(invalid_input) for a mask without a voxel inside. The cost is the size of the
    /// object's box, grown by a correction's length.
    explicit ExistingSurface(const Mask& mask, const Work& work = {});

    /// Radius of the largest ball that fits into the object, mm.
    double inscribed_radius_mm() const { return inscribed_radius_mm_; }
    /// Largest distance of an inside voxel's centre from the mean of them all, mm.
    double radius_mm() const { return radius_mm_; }
    const Grid& grid() const { return grid_; }
    /// The voxels at which f0 is known, a part of the grid or a little more. Beyond, f0 falls by 1 mm to the millimetre.
    const Grid& window() const { return window_; }
    std::int64_t voxels_inside() const { return voxels_inside_; }
    /// Around the voxels inside.
    const IndexBox& object_box() const { return object_; }
    /// Those, and one more on each side: f0 > 0 nowhere else.
    Grid object_grid() const {
        return grid_of(grid_, {{object_.low.i - 1, object_.low.j - 1, object_.low.k - 1},
                               {object_.high.i + 1, object_.high.j + 1, object_.high.k + 1}});
    }
    /// The window in the mask's indices.
    IndexBox window_box() const {
        const Index3& size = window_.size;
        return {first_, {first_.i + size.i - 1, first_.j + size.j - 1, first_.k + size.k - 1}};
    }

    /// f0 at the window's voxels.
    std::span<const float> window_values() const { return values_; }

    double value(const Vec3& position) const;
    /// At a voxel's centre.
    double value_at_voxel(const Index3& voxel) const;

private:
    Grid grid_, window_;  ///< the mask's; a part of it, or a little more
    IndexBox object_;
    Index3 first_;  ///< the window's first voxel, in the mask's indices
    Affine3 to_window_;
    std::vector<float> values_;
    std::int64_t voxels_inside_ = 0;
    double inscribed_radius_mm_ = 0, radius_mm_ = 0;
};

/// What is corrected, with a surface of the mask found before, and the image that shows the object, if there is one.
struct MaskToCorrect {
    const Mask& mask;
    const ExistingSurface& surface;
    const Image* image = nullptr;
};

/// f0 at the window's voxels where smoothing moves no curved surface, with the same signs: 2 f0 less f0 smoothed once more.
/// By f0 itself a ball of 5 voxels' radius loses a twelfth of its volume, by this a fortieth. Corrections by it come out
/// worse (bench/correct.py: Dice .9374 for .9401).
std::vector<float> unshrunk_values(const ExistingSurface& surface, const Work& work = {});
/// No value at a voxel's centre is nearer to 0, mm.
float least_value(const ExistingSurface& surface);

/// Of the largest ball in the object: how far neighbouring surface errors are alike. At least kLeastLengthVoxels of the
/// largest voxel side.
inline constexpr double kLengthOfRadius = 0.5;
inline constexpr double kLeastLengthVoxels = 1.5;
/// Beyond so many lengths a correction changes nothing.
inline constexpr double kReachLengths = 3.2;

/// The length l of a surface's corrections, mm.
double correction_length_mm(const ExistingSurface& surface);

}  // namespace kontur
