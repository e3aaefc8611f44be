// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <random>
#include <string>

#include "kontur/shape/contour.h"
#include "kontur/shape/volume.h"
#include "true_border.h"

namespace kontur {

/// A body whose truth is known, and whoever draws it.
class Truth {
public:
    enum class Hand { exact, unsteady };

    /// Reads what truths.py wrote into a folder.
    Truth(const std::filesystem::path& folder, Hand hand);

    const std::string& name() const { return name_; }
    const Grid& grid() const { return distance_.grid; }
    double cube_mm() const { return grid().spacing_mm().x; }
    double drawing_voxel_mm() const { return cube_mm() / 2; }
    /// What was drawn on, where there is one.
    const std::optional<Image>& image() const { return image_; }
    double diameter_mm() const { return diameter_mm_; }
    double volume_mm3() const { return volume_mm3_; }
    const Box3& box() const { return box_; }
    const Vec3& centroid() const { return centroid_; }
    const BorderPoints& border() const { return border_; }
    /// Places inside, for random planes.
    const std::vector<Vec3>& places() const { return places_; }

    /// Signed distance in mm of the true surface, positive inside.
    double distance_at(const Vec3& p) const;
    double dice(const Mask& mask) const;

    /// What the annotator draws in the plane; nothing where it misses the body.
    std::vector<Contour> draw(const Plane& plane) const;

private:
    std::string name_;
    Hand hand_;
    Mask fine_;
    BorderPoints border_;
    Image distance_;
    std::optional<Image> image_;
    Affine3 to_index_;
    double diameter_mm_ = 0, volume_mm3_ = 0;
    Box3 box_;
    Vec3 centroid_;
    std::vector<Vec3> places_;
};

}  // namespace kontur
