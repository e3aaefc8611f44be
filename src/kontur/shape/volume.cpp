// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "kontur/base/error.h"
#include "kontur/shape/label_choice_error.h"

namespace kontur {
namespace {

/// The two samples along one axis and the second one's weight.
struct LinearStep {
    std::int64_t first, second;
    double weight;
};

/// Within half a voxel beyond the outermost centres the outermost value holds; further out there is none.
bool linear_step(double index, std::int64_t size, LinearStep& step) {
    const double last = static_cast<double>(size - 1);
    if (!(index >= -0.5 && index <= last + 0.5)) return false;
    const double clamped = std::clamp(index, 0.0, last);
    step.first = static_cast<std::int64_t>(clamped);
    step.second = std::min(step.first + 1, size - 1);
    step.weight = clamped - static_cast<double>(step.first);
    return true;
}

/// Mask of the voxels for which `inside(value)` holds.
template <typename Inside>
Mask select(const Image& image, const Inside& inside) {
    check_image(image);
    Mask mask{image.grid, std::vector<std::uint8_t>(static_cast<std::size_t>(image.grid.voxel_count()))};
    std::visit(
        [&](const auto& samples) {
            std::transform(samples.begin(), samples.end(), mask.values.begin(),
                           [&](auto value) { return static_cast<std::uint8_t>(inside(value)); });
        },
        image.samples);
    return mask;
}

void check_count(std::size_t values, const Grid& grid, std::string_view name) {
    check_grid(grid);
    if (static_cast<std::int64_t>(values) != grid.voxel_count())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} has {} values for a grid of {} voxels", name, values, grid.voxel_count()));
}

bool is_label(double value) { return std::trunc(value) == value && std::abs(value) < 9.2e18; }

[[noreturn]] void refuse_fractions(const std::vector<float>& values, float first) {
    const auto count = std::count_if(values.begin(), values.end(), [](float value) { return !is_label(value); });
    throw Error(ErrorKind::invalid_input, "the image is no label map: " + std::to_string(count) +
                                              " voxels hold values that are not integers, the first is " +
                                              fmt::format("{}", first));
}

std::string list_of(const std::map<std::int64_t, std::int64_t>& labels) {
    constexpr std::size_t kMaxListed = 20;
    std::string list;
    std::size_t listed = 0;
    for (const auto& [label, count] : labels) {
        if (++listed > kMaxListed) return list + " and " + std::to_string(labels.size() - kMaxListed) + " more";
        list += (list.empty() ? "" : ", ") + std::to_string(label);
    }
    return list.empty() ? "none" : list;
}

}  // namespace

void check_mask(const Mask& mask, std::string_view name) { check_count(mask.values.size(), mask.grid, name); }

void check_image(const Image& image, std::string_view name) {
    check_count(std::visit([](const auto& samples) { return samples.size(); }, image.samples), image.grid, name);
}

Box3 bounding_box(const Mask& mask) {
    check_mask(mask);
    Box3 box;
    const Index3& n = mask.grid.size;
    for (std::int64_t k = 0; k < n.k; ++k)
        for (std::int64_t j = 0; j < n.j; ++j)
            for (std::int64_t i = 0; i < n.i; ++i)
                if (mask.values[mask.grid.offset(i, j, k)]) box.extend(mask.grid.center_mm(i, j, k));
    return box;
}

double sample(const Image& image, std::size_t offset) {
    return std::visit([&](const auto& samples) { return static_cast<double>(samples[offset]); }, image.samples);
}

double interpolate(const Image& image, const Affine3& mm_to_index, const Vec3& point_mm, double outside) {
    const Vec3 index = mm_to_index.apply(point_mm);
    LinearStep i, j, k;
    const Index3& size = image.grid.size;
    if (!linear_step(index.x, size.i, i) || !linear_step(index.y, size.j, j) || !linear_step(index.z, size.k, k))
        return outside;
    return std::visit(
        [&](const auto& samples) {
            const auto value = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
                return static_cast<double>(samples[image.grid.offset(x, y, z)]);
            };
            const auto along_i = [&](std::int64_t y, std::int64_t z) {
                return std::lerp(value(i.first, y, z), value(i.second, y, z), i.weight);
            };
            const auto along_j = [&](std::int64_t z) {
                return std::lerp(along_i(j.first, z), along_i(j.second, z), j.weight);
            };
            return std::lerp(along_j(k.first), along_j(k.second), k.weight);
        },
        image.samples);
}

Mask select_label(const Image& image, double label) {
    return select(image, [&](auto value) { return static_cast<double>(value) == label; });
}

Mask select_nonzero(const Image& image) {
    return select(image, [](auto value) { return value != 0; });
}

std::map<std::int64_t, std::int64_t> count_labels(const Image& image, std::size_t max_labels) {
    check_image(image);
    std::map<std::int64_t, std::int64_t> counts;
    std::visit(
        [&](const auto& samples) {
            using Value = typename std::decay_t<decltype(samples)>::value_type;
            for (std::size_t begin = 0, end; begin < samples.size(); begin = end) {
                // Labels come in long runs: one look-up for each run.
                const Value value = samples[begin];
                end = begin + 1;
                while (end < samples.size() && samples[end] == value) ++end;
                if (value == 0) continue;
                if constexpr (std::is_floating_point_v<Value>)
                    if (!is_label(value)) refuse_fractions(samples, value);
                counts[static_cast<std::int64_t>(value)] += static_cast<std::int64_t>(end - begin);
                if (counts.size() > max_labels)
                    throw Error(ErrorKind::invalid_input, "the image is no label map: it has more than " +
                                                              std::to_string(max_labels) + " different values");
            }
        },
        image.samples);
    return counts;
}

Mask select_mask(const Image& image, std::optional<std::int64_t> label, const std::string& name) {
    std::map<std::int64_t, std::int64_t> labels;
    try {
        labels = count_labels(image);
    } catch (const Error& error) {
        throw error.with_context(name);
    }
    if (!label && labels.size() > 1)
        throw LabelChoiceError(name + " has " + std::to_string(labels.size()) + " labels; choose one of " + list_of(labels) +
                               " with the option label");
    if (label && !labels.contains(*label))
        throw Error(ErrorKind::invalid_input,
                    name + " has no label " + std::to_string(*label) + "; its labels are " + list_of(labels));
    return label ? select_label(image, static_cast<double>(*label)) : select_nonzero(image);
}

}  // namespace kontur
