// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/label_boxes.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/label_maps.h"

namespace kontur {
namespace {

TEST(LabelBoxes, AreThoseOfEachLabelAsASlowLookFindsThem) {
    std::uint32_t state = 1;
    const Grid grid = test::index_grid({7, 6, 5});
    const Image map = test::label_map(grid, [&](const Index3&) {
        state = state * 1664525U + 1013904223U;
        return state >> 27 < 28 ? 0 : static_cast<int>(state >> 24 & 3);
    });
    const auto counts = count_labels(map);
    const auto boxes = label_boxes(map);
    ASSERT_EQ(boxes.size(), counts.size());
    for (const auto& [label, found] : boxes) {
        EXPECT_EQ(found.voxels, counts.at(label));
        const Mask mask = select_label(map, static_cast<double>(label));
        const Box3 box = bounding_box(mask);
        EXPECT_EQ(box.min, grid.center_mm(found.box.low.i, found.box.low.j, found.box.low.k));
        EXPECT_EQ(box.max, grid.center_mm(found.box.high.i, found.box.high.j, found.box.high.k));
        const Mask part = label_mask(map, label, found.box);
        EXPECT_EQ(bounding_box(part).min, box.min);
        EXPECT_EQ(std::count(part.values.begin(), part.values.end(), 1), found.voxels);
    }
}

TEST(LabelBoxes, RefusesWhatIsNoLabelMap) {
    const Image image{test::index_grid({2, 1, 1}), std::vector<float>{0, 0.5F}};
    EXPECT_KONTUR_ERROR(label_boxes(image), ErrorKind::invalid_input, "no label map: 1 voxels");
}

}  // namespace
}  // namespace kontur
