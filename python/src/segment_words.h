// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "casters.h"
#include "kontur/drawing/corners.h"
#include "kontur/drawing/reconcile.h"
#include "kontur/image/follow_image.h"
#include "kontur/shape/fill_rule.h"
#include "kontur/sureness/image_slice.h"

namespace kontur::python {

template <>
struct Words<Conflicts> {
    static constexpr std::array values{Conflicts::reconcile, Conflicts::newest_wins, Conflicts::exact};
};

template <>
struct Words<Corners> {
    static constexpr std::array values{Corners::rounded, Corners::faithful};
};

template <>
struct Words<FillRule> {
    static constexpr std::array values{FillRule::even_odd, FillRule::declared};
};

template <>
struct Words<UseImage> {
    static constexpr std::array values{UseImage::off, UseImage::automatic};
};

template <>
struct Words<ImageVerdict> {
    static constexpr std::array values{ImageVerdict::none,    ImageVerdict::labels, ImageVerdict::unknown,
                                       ImageVerdict::no_help, ImageVerdict::astray, ImageVerdict::used};
};

template <>
struct Words<PlaneChoice> {
    static constexpr std::array values{PlaneChoice::any, PlaneChoice::image_slices};
};

}  // namespace kontur::python
