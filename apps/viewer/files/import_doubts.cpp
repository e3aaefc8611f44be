// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/import_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace kontur::viewer {
namespace {

constexpr std::size_t kMostNamed = 5;  ///< structures; a set of another patient has dozens, and one sentence is enough

/// How many voxels a point lies from the image's outermost faces; 0 inside.
double voxels_outside(const Vec3& index, const Index3& size) {
    const auto beyond = [](double at, std::int64_t n) {
        return std::max({-0.5 - at, at - static_cast<double>(n) + 0.5, 0.0});
    };
    return std::max({beyond(index.x, size.i), beyond(index.y, size.j), beyond(index.z, size.k)});
}

/// Distance in mm from the image's box, in the patient's axes, to the contours' one; 0 where they meet.
double distance_mm(const Box3& image, const Box3& drawn) {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double gap = std::max({drawn.min[axis] - image.max[axis], image.min[axis] - drawn.max[axis], 0.0});
        squared += gap * gap;
    }
    return std::sqrt(squared);
}

std::optional<std::string> doubt(const ContourSet& set, const Grid& image, double most_outside) {
    const Affine3 mm_to_index = image.index_to_mm.inverse();
    std::size_t count = 0, outside = 0;
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) {
            ++count;
            outside += voxels_outside(mm_to_index.apply(p), image.size) > 1;
        }
    if (static_cast<double>(outside) <= most_outside * static_cast<double>(count)) return std::nullopt;
    const double percent = 100.0 * static_cast<double>(outside) / static_cast<double>(count);
    const double away = distance_mm(image.bounds_mm(), bounding_box(set));
    const std::string name = set.name.empty() ? "What was drawn" : set.name;
    if (away > 0) return fmt::format("{} lies {:.0f} mm outside of the image.", name, std::ceil(away));
    return fmt::format("{:.0f} % of the points of {} lie outside of the image.", percent, name);
}

/// People know patients; frames of reference are numbers that nobody can check.
std::optional<std::string> doubt_of_source(const Source& drawn, const Source& image) {
    const auto differ = [](const std::string& a, const std::string& b) { return !a.empty() && !b.empty() && a != b; };
    if (differ(drawn.patient, image.patient))
        return fmt::format("It was drawn on an image of {}, and this image is of {}.", drawn.patient, image.patient);
    if (!differ(drawn.frame_of_reference_uid, image.frame_of_reference_uid)) return std::nullopt;
    const std::string of = drawn.patient.empty() ? "" : fmt::format(" of {}", drawn.patient);
    return fmt::format("It was drawn on another scan{} than this one: their frames of reference differ.", of);
}

}  // namespace

std::vector<std::string> import_doubts(const std::vector<ContourSet>& sets, const Source& drawn, const Grid& image,
                                       const Source& image_source, double most_outside) {
    std::vector<std::string> doubts;
    if (auto sentence = doubt_of_source(drawn, image_source)) doubts.push_back(std::move(*sentence));
    std::size_t outside = 0;
    for (const ContourSet& set : sets)
        if (auto sentence = doubt(set, image, most_outside); sentence && ++outside <= kMostNamed)
            doubts.push_back(std::move(*sentence));
    if (outside > kMostNamed) doubts.push_back(fmt::format("{} more structures lie outside of it.", outside - kMostNamed));
    return doubts;
}

}  // namespace kontur::viewer
