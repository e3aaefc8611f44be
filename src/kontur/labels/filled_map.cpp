// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/filled_map.h"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace kontur {

FilledMap::FilledMap(Image labels)
    : labels_(std::move(labels)), is_painted_(static_cast<std::size_t>(labels_.grid.voxel_count())) {
    std::visit(
        [&](const auto& samples) {
            for (std::size_t n = 0; n < samples.size(); ++n) is_painted_[n] = samples[n] != 0;
        },
        labels_.samples);
}

void FilledMap::set_label(std::size_t n, std::int64_t label) {
    std::visit([&](auto& samples) { samples[n] = static_cast<typename std::decay_t<decltype(samples)>::value_type>(label); },
               labels_.samples);
}

Index3 FilledMap::index(std::size_t n) const { return index_at(n, labels_.grid.size); }

std::vector<double> depths_mm(const ImplicitFunction& function, const std::vector<Vec3>& places_mm, const Work& work) {
    std::vector<double> values(places_mm.size());
    std::vector<Vec3> gradients(places_mm.size());
    function.values_and_gradients(places_mm, values, gradients, work);
    for (std::size_t n = 0; n < values.size(); ++n) values[n] /= std::max(norm(gradients[n]), kRidgeSlope);
    return values;
}

}  // namespace kontur
