// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/corrections.h"
#include "kontur/correct/existing_surface.h"
#include "kontur/correct/image_reach.h"
#include "kontur/shape/volume.h"

namespace kontur {

class SurfaceChange;

struct CorrectOptions {
    /// Of the length that follows from the mask: how far a correction is carried on. In [0.25, 4].
    double reach = 1;
    /// Takes away the pieces that a correction cuts off.
    bool drop_loose = false;
};

/// What was said in one plane.
enum class CorrectionKind { outline, piece, empty, confirmed };
std::string_view name(CorrectionKind kind) noexcept;

/// A plane that was corrected, or looked at and found right.
struct CorrectedPlane {
    CorrectionKind kind;
    Plane plane;
    std::vector<std::size_t> contours;  ///< of the drawing
    double largest_move_mm;             ///< of the mask's surface, along the drawn line
};

/// Voxels that hung together with a larger part before the correction and do not now.
struct LoosePiece {
    std::int64_t voxels;
    double volume_ml;
    Vec3 position;  ///< mm, the centre of one of them
};

struct CorrectReport {
    double length_mm = 0;  ///< l, over which neighbouring errors are alike
    double reach_mm = 0;   ///< beyond, nothing changes
    std::vector<CorrectedPlane> planes;
    std::int64_t added_drawn = 0, removed_drawn = 0;      ///< voxels in drawn planes
    std::int64_t added_carried = 0, removed_carried = 0;  ///< voxels beside them
    std::int64_t added_image = 0, removed_image = 0;      ///< voxels that the image decided
    std::optional<ImageReach> image{};                    ///< nothing without an image
    double volume_before_ml = 0, volume_ml = 0;
    double dice = 1;  ///< of the mask before and after
    std::vector<LoosePiece> loose_pieces;
    bool dropped_loose = false;
    std::vector<std::string> warnings;
};

/// A corrected mask, and for each of its voxels a CorrectedVoxel: how it came to be what it is.
struct CorrectedMask {
    Mask mask;
    std::vector<std::uint8_t> origin;
    CorrectReport report;
    /// Of the mask's function f0, without what slices, the image and loose pieces say voxel by voxel.
    std::shared_ptr<const SurfaceChange> change{};
};

/// Corrects a mask by what was drawn in some planes. The change is carried on to both sides of a plane over about half the
/// radius of the largest ball in the mask, and to nothing beyond kReachLengths times that: all other voxels stay. Without
/// corrections, or with some that repeat the mask, the mask stays as it is. The same bytes for any number of threads. Throws
/// Error(invalid_input) for options out of their range, an empty mask and corrections that cannot be understood.
CorrectedMask correct(const Mask& mask, const Corrections& corrections, const CorrectOptions& options = {},
                      const Work& work = {});
/// What is corrected, with a surface of the mask found before, and the image that shows the object, if there is one.
struct MaskToCorrect {
    const Mask& mask;
    const ExistingSurface& surface;
    const Image* image = nullptr;
};
/// The same; an image decides how far corrections are carried, up to kFartherWithImage times as far (image_reach.h).
CorrectedMask correct(const MaskToCorrect& what, const Corrections& corrections, const CorrectOptions& options = {},
                      const Work& work = {});
/// With a surface found before, of this mask: for several corrections one after the other.
CorrectedMask correct(const Mask& mask, const ExistingSurface& surface, const Corrections& corrections,
                      const CorrectOptions& options = {}, const Work& work = {});

/// "1,840 voxels changed (3.2 ml less), up to 9 mm beside the drawn planes" for people.
std::string sentence(const CorrectReport& report);

}  // namespace kontur
