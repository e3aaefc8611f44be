// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/sureness/image_share.h"

namespace kontur {

/// Whether the image is asked where the surface runs between the contours.
enum class UseImage {
    off,        ///< the contours alone
    automatic,  ///< where it is shown, at contours left out, that the image helps
};
std::string_view name(UseImage use) noexcept;

/// What became of the image.
enum class ImageVerdict {
    none,     ///< there was none, or it was not to be used
    labels,   ///< it is a mask or a label map: what it shows is no image's border; not used
    unknown,  ///< too few planes were drawn to tell whether it helps; not used
    no_help,  ///< it does not help at contours left out; not used
    astray,   ///< it helps there, but the surface that follows it leaves where it was asked; not used
    used,
};
std::string_view name(ImageVerdict verdict) noexcept;

struct ImageReport {
    ImageVerdict verdict = ImageVerdict::none;
    std::size_t planes_left_out = 0;
    double error_without_mm = 0;  ///< mean distance of contours left out from the surface through the others ...
    double error_with_mm = 0;     ///< ... and the same with the image
    bool displaced = false;       ///< ... or from a surface that was displaced there on purpose (displace.h)
    bool walked = false;          ///< the surface is drawn to that of a random walk on the image's voxels (voxel_walk.h)
    double weight = 0;            ///< how far what the image shows is followed, 0 to 1: the walk, or else the movement
    double wrong_without = 0;  ///< cells of planes left out on the wrong side, over those inside: by the contours alone ...
    double wrong_with = 0;     ///< ... and by such a walk
    double largest_move_mm = 0;        ///< of the surface, at the points asked
    std::int64_t intensities = 0;      ///< read from the image
    double on_contours_mm = 0;         ///< the largest change of f at some 500 of the drawn points
    std::vector<ImageShare> shares{};  ///< where it was asked, and how much surer it made the surface there

    /// Of the error without the image, measured where planes were left out or displaced; 1 where it is not used.
    double share_left() const;
};

/// One sentence for people.
std::string sentence(const ImageReport& report);

/// Calls visit(key, value) for all that files say of the image, in their order; of one that was not asked only its verdict.
template <class Visit>
void visit_facts(const ImageReport& image, const Visit& visit) {
    visit("verdict", name(image.verdict));
    if (image.verdict == ImageVerdict::none) return;
    visit("sentence", sentence(image));
    visit("planes_left_out", image.planes_left_out);
    visit("displaced", image.displaced);
    visit("walked", image.walked);
    visit("weight", image.weight);
    visit("wrong_without", image.wrong_without);
    visit("wrong_with", image.wrong_with);
    visit("error_without_mm", image.error_without_mm);
    visit("error_with_mm", image.error_with_mm);
    visit("largest_move_mm", image.largest_move_mm);
    visit("intensities", image.intensities);
    visit("on_contours_mm", image.on_contours_mm);
}

}  // namespace kontur
