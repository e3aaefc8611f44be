// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/correction_data.h"
#include "kontur/shape/index_box.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// So many times farther than without an image a correction may be carried with one.
inline constexpr double kFartherWithImage = 2.5;
/// Of the object's radius: how far what the image shows at one place tells of others.
inline constexpr double kLooksReach = 0.24;

/// A mask, and what was said of it.
struct MaskCorrection {
    const Mask& mask;
    const ExistingSurface& surface;
    const ContourSet& drawing;
    const std::vector<CorrectedSection>& sections;
    double reach;  ///< CorrectOptions'
};

/// Where a correction may be carried with an image: a box of the mask's voxels, and what the image shows at each of them,
/// from 0 to 1 (IntensityScale); NaN where it shows nothing.
struct CarriedBox {
    IndexBox box;
    Grid grid;  ///< of the box
    std::vector<float> looks{};
};

/// Nothing where the corrections repeat the mask or lie beyond its grid.
std::optional<CarriedBox> carried_box(const MaskCorrection& correction, const Image& image, const Work& work);

/// What is inside by some of the planes, at the voxels of a box.
struct CarriedVoxels {
    std::vector<std::uint8_t> alone;  ///< by the correction without the image
    std::vector<float> walked;        ///< probability by a walk on the image; where nothing is asked that of `alone`

    /// The walk's side where it is surer than 1 - 0.5 / weight, else that without the image; what hangs together with
    /// nothing that was on its side without the image stays as it was, too.
    std::vector<std::uint8_t> followed(const Index3& size, double weight) const;
};

/// A random walk (Grady 2006) from voxel to voxel, which ends in drawn planes and where f0 + g is sure: it chooses between
/// the mask and the correction carried farther, by what the image shows on both sides of the drawn lines nearby. `sections`:
/// all of the correction's, or some.
CarriedVoxels walk_carried(const MaskCorrection& correction, const std::vector<CorrectedSection>& sections,
                           const CarriedBox& at, const Work& work);

/// Whether the centre of a voxel is nearer to a plane than half a voxel, along the plane's normal.
bool is_in_plane(const Plane& plane, const Grid& grid, const Vec3& center);

}  // namespace kontur
