// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "kontur/base/geometry.h"

/// What an upper abdomen is made of for the CT. Internal to the phantom.
namespace kontur {

/// From this depth below the surface on, the tissue has this radiodensity.
struct Layer {
    double from_mm, hu;
};

struct Tissue {
    Box3 bounds;  ///< nothing of it lies outside
    std::function<double(const Vec3&)> depth;
    std::vector<Layer> layers;  ///< by growing depth, the first from 0
};

constexpr double kAirHu = -1000;

/// The tissues in painting order: each replaces what lies at its place before. The exact bodies come last, so that the image
/// shows them whole; only vessels and the metastasis are painted into the liver.
std::vector<Tissue> abdominal_tissues();

}  // namespace kontur
