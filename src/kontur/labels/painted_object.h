// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kontur/labels/label_boxes.h"
#include "kontur/labels/painted_slices.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// One label of a sparse map, as it was painted.
struct PaintedObject {
    std::int64_t label = 0;
    LabelBox found;
    IndexBox box;                                 ///< of the image; what `slices` count from
    Grid grid;                                    ///< of the box
    std::vector<PaintedSlice> slices;             ///< on `grid`, sorted by axis and index
    std::array<std::vector<bool>, 3> is_whole{};  ///< by axis and index of the image: whether a slice was painted as a whole

    /// Whether a slice says what the voxel of the image is.
    bool is_known(const Index3& at) const;
    /// The only axis across which slices were painted; -1 when there are several.
    int only_axis() const;
    /// Indices in the image of the slices painted across an axis.
    std::vector<std::int64_t> indices(int axis) const;
};

/// Looks at a label in its box, grown by `margin` voxels where the image has them.
PaintedObject painted_object(const Image& labels, std::int64_t label, const LabelBox& found, std::int64_t margin);

/// Several labels as one object, on the slices on which all of them were painted as far as they reach: a slice on which one
/// of them was left out does not show the union.
PaintedObject united(std::span<const PaintedObject* const> objects, const Grid& image);

/// The outlines of all sections (see section_contours).
ContourSet contours_of(const PaintedObject& object, double smoothing_voxels);

/// Sets of labels that touch each other, face to face, in what was painted; those that touch none are left out.
std::vector<std::vector<std::int64_t>> touching_labels(const Image& labels);

}  // namespace kontur
