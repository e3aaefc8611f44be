// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Where f has a ridge it is taken to be this steep.
inline constexpr double kRidgeSlope = 1e-3;

/// A label map while it is filled, which remembers what was painted. Takes a bit more for each voxel than the map alone.
class FilledMap {
public:
    explicit FilledMap(Image labels);

    const Image& labels() const { return labels_; }
    bool is_painted(std::size_t n) const { return is_painted_[n]; }
    std::int64_t label(std::size_t n) const { return static_cast<std::int64_t>(sample(labels_, n)); }
    void set_label(std::size_t n, std::int64_t label);
    /// Of the voxel at an offset.
    Index3 index(std::size_t n) const;

    Image take() { return std::move(labels_); }

private:
    Image labels_;
    std::vector<bool> is_painted_;
};

/// How deep places lie in an object whose surface is where f is 0, in mm: f / |grad f|.
std::vector<double> depths_mm(const ImplicitFunction& function, const std::vector<Vec3>& places_mm, const Work& work);

}  // namespace kontur
