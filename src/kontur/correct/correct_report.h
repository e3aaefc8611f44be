// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/correct/image_reach.h"

namespace kontur {

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

/// "1840 voxels changed, 1510 of them beside the drawn planes; 3.2 ml less, 1540.6 ml in all" for people.
std::string sentence(const CorrectReport& report);

/// Throws Error(invalid_input) for options out of their range.
void check_options(const CorrectOptions& options);

}  // namespace kontur
