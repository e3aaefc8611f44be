// SPDX-License-Identifier: Apache-2.0
// What people are told of the image.
#include "kontur/image/image_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace kontur {
namespace {

constexpr double kWholly = 0.95;

std::string no_help(const ImageReport& report) {
    if (report.displaced)
        return fmt::format(
            "the image does not help between the contours (a surface displaced by {:.2g} mm at them is {:.2g} mm "
            "off with it); not used",
            report.error_without_mm, report.error_with_mm);
    return fmt::format("the image {} ({:.2g} mm off at left-out contours without it, {:.2g} with it); not used",
                       report.error_with_mm < report.error_without_mm
                           ? "helps too little, or in too few planes, to be sure of it"
                           : "does not help between the contours",
                       report.error_without_mm, report.error_with_mm);
}

/// How far it is followed: what is all but wholly needs no figure.
std::string where_used(const ImageReport& report) {
    return report.weight < kWholly
               ? fmt::format("followed {:.0f} % of the way between the contours", std::max(1.0, 100 * report.weight))
               : "used between the contours";
}

std::string sentence_of_use(const ImageReport& report) {
    if (report.walked)
        return fmt::format(
            "the image lowers what is wrong in left-out planes from {:.2g} to {:.2g} % of the object; {}, voxel by voxel",
            100 * report.wrong_without, 100 * report.wrong_with, where_used(report));
    if (report.displaced)
        return fmt::format("the image takes a surface displaced by {:.2g} mm at the contours back to {:.2g} mm; {}",
                           report.error_without_mm, report.error_with_mm, where_used(report));
    return fmt::format("the image lowers the error at left-out contours from {:.2g} to {:.2g} mm; {}",
                       report.error_without_mm, report.error_with_mm, where_used(report));
}

}  // namespace

double ImageReport::share_left() const {
    if (verdict != ImageVerdict::used) return 1;
    const double without = walked ? wrong_without : error_without_mm, with = walked ? wrong_with : error_with_mm;
    return without > 0 ? 1 - weight * (1 - std::min(1.0, with / without)) : 1;
}

std::string_view name(UseImage use) noexcept { return use == UseImage::off ? "off" : "auto"; }

std::string_view name(ImageVerdict verdict) noexcept {
    switch (verdict) {
        case ImageVerdict::none:
            return "none";
        case ImageVerdict::labels:
            return "labels";
        case ImageVerdict::unknown:
            return "unknown";
        case ImageVerdict::no_help:
            return "no_help";
        case ImageVerdict::astray:
            return "astray";
        case ImageVerdict::used:
            return "used";
    }
    return "?";
}

std::string sentence(const ImageReport& report) {
    switch (report.verdict) {
        case ImageVerdict::none:
            return "the image was not used";
        case ImageVerdict::labels:
            return "the image is a mask or a label map; not used between the contours";
        case ImageVerdict::unknown:
            return "too little is drawn to tell whether the image helps between the contours; not used";
        case ImageVerdict::no_help:
            return no_help(report);
        case ImageVerdict::astray:
            return "the image leads the surface farther from the contours than it was asked for; not used";
        case ImageVerdict::used:
            return sentence_of_use(report);
    }
    return "";
}

}  // namespace kontur
