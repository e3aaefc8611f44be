// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kontur/shape/grid.h"

namespace kontur {

/// A binary mask: 0 outside, 1 inside, i fastest; `values.size() == grid.voxel_count()`.
struct Mask {
    Grid grid;
    std::vector<std::uint8_t> values;
};

/// The box of the centres of the voxels inside, in mm; empty when there are none.
Box3 bounding_box(const Mask& mask);

/// A scalar image (CT, MR, label map) in the narrowest of these sample types that holds its values exactly; intensities
/// are already rescaled (Hounsfield units for CT). 64-bit and double sources become float.
struct Image {
    using Samples = std::variant<std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>,
                                 std::vector<std::int32_t>, std::vector<float>>;
    Grid grid;
    Samples samples;  ///< `grid.voxel_count()` values, i fastest
};

/// Throw Error(invalid_input), naming what it is, for a grid that check_grid refuses and for other than one value for each
/// of its voxels.
void check_mask(const Mask& mask, std::string_view name = "the mask");
void check_image(const Image& image, std::string_view name = "the image");

/// The value at a linear offset (see Grid::offset).
double sample(const Image& image, std::size_t offset);

/// Trilinear interpolation at a point in mm; `outside` beyond the outermost voxel centres by more than half a voxel.
double interpolate(const Image& image, const Affine3& mm_to_index, const Vec3& point_mm, double outside);

/// Voxels with exactly this value. `label` is compared as a number. This and the following throw as check_image does.
Mask select_label(const Image& image, double label);

/// Voxels with a value other than 0.
Mask select_nonzero(const Image& image);

/// Voxel count of every value except 0. Throws Error(invalid_input) when the image is no label map: a value that is not
/// an integer (naming it and how many) or more than `max_labels` different ones.
std::map<std::int64_t, std::int64_t> count_labels(const Image& image, std::size_t max_labels = 4096);

/// The mask that a label map stands for: the voxels with the value `label`, or without one all voxels other than 0. Throws
/// Error(invalid_input), with `name` for the image, when it is no label map, when it holds several labels and none was
/// chosen, or when the chosen one is not there; both list the labels.
Mask select_mask(const Image& image, std::optional<std::int64_t> label, const std::string& name);

}  // namespace kontur
