// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/mask_course.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "kontur/base/error.h"

namespace kontur {

MaskCourse::MaskCourse(const MovingFunction& function, std::vector<Mask> masks, const Work& work)
    : course_(function.course()), masks_(std::move(masks)) {
    const std::size_t moments = function.functions().size();
    if (masks_.size() != moments)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("there are {} masks of {} moments; each needs one", masks_.size(), moments));
    const Mask& first = masks_.front();
    std::vector<Vec3> places;
    for (std::size_t v = 0; v < first.values.size(); ++v) {
        const auto differs = [&](const Mask& mask) { return mask.values[v] != first.values[v]; };
        if (std::none_of(masks_.begin(), masks_.end(), differs)) continue;
        voxels_.push_back(v);
        const Index3 at = index_at(v, first.grid.size);
        places.push_back(first.grid.center_mm(at.i, at.j, at.k));
    }
    std::vector<double> values(places.size());
    values_.resize(places.size() * moments);
    for (std::size_t k = 0; k < moments; ++k) {
        work.report("values between moments", static_cast<double>(k) / static_cast<double>(moments));
        function.functions()[k].values(places, values, work.untold());
        for (std::size_t n = 0; n < places.size(); ++n) {
            // A sheet that no contour touches is not in the mask, whatever f says.
            const bool is_inside = masks_[k].values[voxels_[n]] != 0;
            if (is_inside != (values[n] > 0)) values[n] = is_inside ? std::numeric_limits<double>::min() : 0.0;
            values_[n * moments + k] = values[n];
        }
    }
}

Mask MaskCourse::at(double time) const {
    const TimeCourse::Place place = course_.place_of(time);
    Mask mask = masks_[place.before];
    if (place.before == place.after) return mask;
    const std::size_t moments = masks_.size();
    for (std::size_t n = 0; n < voxels_.size(); ++n) {
        const std::span<const double> values(&values_[n * moments], moments);
        if ((values[place.before] > 0) != (values[place.after] > 0))
            mask.values[voxels_[n]] = course_.value(place, values) > 0;
    }
    return mask;
}

double MaskCourse::differing_ml(std::size_t one, std::size_t other) const {
    const auto differs = [&](std::size_t v) { return masks_[one].values[v] != masks_[other].values[v]; };
    const auto voxels = std::count_if(voxels_.begin(), voxels_.end(), differs);
    return static_cast<double>(voxels) * masks_.front().grid.voxel_volume_mm3() / 1000;
}

double MaskCourse::differing_ml() const {
    return static_cast<double>(voxels_.size()) * masks_.front().grid.voxel_volume_mm3() / 1000;
}

double volume_ml(const Mask& mask) {
    const auto voxels = std::count_if(mask.values.begin(), mask.values.end(), [](auto v) { return v != 0; });
    return static_cast<double>(voxels) * mask.grid.voxel_volume_mm3() / 1000;
}

}  // namespace kontur
