// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "casters.h"
#include "kontur/drawing/corners.h"
#include "kontur/drawing/reconcile.h"
#include "kontur/image/follow_image.h"
#include "kontur/shape/fill_rule.h"

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

}  // namespace kontur::python

namespace pybind11::detail {

template <>
struct type_caster<kontur::UseImage> : word_caster<kontur::UseImage> {};

template <>
struct type_caster<kontur::ImageVerdict> : word_caster<kontur::ImageVerdict> {};

template <>
struct type_caster<kontur::Conflicts> : word_caster<kontur::Conflicts> {};

template <>
struct type_caster<kontur::Corners> : word_caster<kontur::Corners> {};

template <>
struct type_caster<kontur::FillRule> : word_caster<kontur::FillRule> {};

}  // namespace pybind11::detail
