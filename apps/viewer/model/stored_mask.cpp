// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/stored_mask.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "kontur/base/error.h"
#include "kontur/shape/inside_box.h"
#include "kontur/shape/sha256.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr std::int64_t kMostVoxels = std::int64_t{1} << 31;  ///< of a grid: correcting takes some bytes for each
constexpr int kCompression = 6;

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorKind::invalid_input, "a stored mask " + why); }

IndexBox box_of(const Mask& mask) {
    const auto box = inside_box<std::uint8_t>(mask.grid.size, mask.values, [](std::uint8_t v) { return v != 0; });
    if (!box) throw Error(ErrorKind::invalid_input, "the mask has no voxel inside, so there is nothing to correct");
    return *box;
}

std::size_t voxels_in(const IndexBox& box) {
    const Index3 size = box.size();
    return static_cast<std::size_t>(size.i * size.j * size.k);
}

/// Calls visit(offset in the mask, number in the box) for every voxel of the box.
template <class Visit>
void for_each_voxel(const Grid& grid, const IndexBox& box, Visit visit) {
    std::size_t number = 0;
    for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
        for (std::int64_t j = box.low.j; j <= box.high.j; ++j) {
            std::size_t offset = grid.offset(box.low.i, j, k);
            for (std::int64_t i = box.low.i; i <= box.high.i; ++i) visit(offset++, number++);
        }
}

json to_json(const Index3& index) { return {index.i, index.j, index.k}; }

Index3 index_from(const json& numbers, std::int64_t least) {
    if (!numbers.is_array() || numbers.size() != 3) refuse("names no three whole numbers");
    Index3 index;
    for (int axis = 0; axis < 3; ++axis) {
        const json& number = numbers[static_cast<std::size_t>(axis)];
        if (!number.is_number_integer() || number.get<double>() < static_cast<double>(least) ||
            number.get<double>() > static_cast<double>(kMostVoxels))
            refuse("has a size or an index that none can have");
        index[axis] = number.get<std::int64_t>();
    }
    return index;
}

Affine3 affine_from(const json& numbers) {
    if (!numbers.is_array() || numbers.size() != 12) refuse("has no 12 numbers that say where its voxels lie");
    Affine3 affine;
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column)
            affine.linear[row][column] = numbers[4 * row + column].get<double>();
        affine.translation[static_cast<int>(row)] = numbers[4 * row + 3].get<double>();
    }
    return affine;
}

}  // namespace

StoredMask::StoredMask(const Mask& mask) : grid_(mask.grid) {
    check_mask(mask);
    box_ = box_of(mask);
    std::string bits((voxels_in(box_) + 7) / 8, '\0');
    for_each_voxel(grid_, box_, [&](std::size_t offset, std::size_t number) {
        if (mask.values[offset]) bits[number / 8] = static_cast<char>(bits[number / 8] | 1 << number % 8);
    });
    uLongf size = compressBound(bits.size());
    packed_.resize(size);
    if (compress2(reinterpret_cast<Bytef*>(packed_.data()), &size, reinterpret_cast<const Bytef*>(bits.data()), bits.size(),
                  kCompression) != Z_OK)
        throw std::bad_alloc();
    packed_.resize(size);
    hash_ = digest(bits);
}

StoredMask::StoredMask(std::string_view header, std::string packed) : packed_(std::move(packed)) {
    const json said = parsed(header);
    const Members m(said);
    grid_.size = index_from(m.at("size"), 1);
    box_ = {index_from(m.at("low"), 0), index_from(m.at("high"), 0)};
    if (static_cast<double>(grid_.size.i) * static_cast<double>(grid_.size.j) * static_cast<double>(grid_.size.k) >
        static_cast<double>(kMostVoxels))
        refuse(fmt::format("has {} x {} x {} voxels; at most {} are possible", grid_.size.i, grid_.size.j, grid_.size.k,
                           kMostVoxels));
    for (int axis = 0; axis < 3; ++axis)
        if (box_.low[axis] > box_.high[axis] || box_.high[axis] >= grid_.size[axis]) refuse("lies beyond its own grid");
    grid_.index_to_mm = affine_from(m.at("index_to_mm"));
    check_grid(grid_);
    hash_ = digest(unpacked());
}

std::string StoredMask::header() const {
    json numbers = json::array();
    for (std::size_t row = 0; row < 3; ++row) {
        for (const double number : grid_.index_to_mm.linear[row]) numbers.push_back(number);
        numbers.push_back(grid_.index_to_mm.translation[static_cast<int>(row)]);
    }
    return to_text({{"size", to_json(grid_.size)},
                    {"index_to_mm", std::move(numbers)},
                    {"low", to_json(box_.low)},
                    {"high", to_json(box_.high)}});
}

Mask StoredMask::mask() const {
    Mask mask{grid_, std::vector<std::uint8_t>(static_cast<std::size_t>(grid_.voxel_count()))};
    const std::string bits = unpacked();
    for_each_voxel(grid_, box_, [&](std::size_t offset, std::size_t number) {
        mask.values[offset] = static_cast<unsigned char>(bits[number / 8]) >> number % 8 & 1;
    });
    return mask;
}

bool MaskVoxels::contains(std::size_t offset) const {
    const IndexBox& box = mask_.box();
    const Index3 at = index_at(offset, mask_.grid().size);
    if (!box.contains(at)) return false;
    const Index3 size = box.size();
    const auto number =
        static_cast<std::size_t>(at.i - box.low.i + size.i * (at.j - box.low.j + size.j * (at.k - box.low.k)));
    return static_cast<unsigned char>(bits_[number / 8]) >> number % 8 & 1;
}

bool StoredMask::meets(const StoredMask& other) const {
    const IndexBox both{{std::max(box_.low.i, other.box_.low.i), std::max(box_.low.j, other.box_.low.j),
                         std::max(box_.low.k, other.box_.low.k)},
                        {std::min(box_.high.i, other.box_.high.i), std::min(box_.high.j, other.box_.high.j),
                         std::min(box_.high.k, other.box_.high.k)}};
    for (int axis = 0; axis < 3; ++axis)
        if (both.low[axis] > both.high[axis]) return false;
    const MaskVoxels own(*this), its(other);
    bool is_met = false;
    for_each_voxel(grid_, both, [&](std::size_t offset, std::size_t) {
        is_met = is_met || (own.contains(offset) && its.contains(offset));
    });
    return is_met;
}

/// zlib checks its sum of the bytes.
std::string StoredMask::unpacked() const {
    std::string bits((voxels_in(box_) + 7) / 8, '\0');
    uLongf size = bits.size();
    const int code = uncompress(reinterpret_cast<Bytef*>(bits.data()), &size, reinterpret_cast<const Bytef*>(packed_.data()),
                                packed_.size());
    if (code == Z_MEM_ERROR) throw std::bad_alloc();
    if (code != Z_OK || size != bits.size()) refuse("is damaged");
    return bits;
}

std::string StoredMask::digest(std::string_view bits) const {
    Sha256 sum;
    const std::string said = header();
    sum.update(std::as_bytes(std::span(said)));
    sum.update(std::as_bytes(std::span(bits)));
    return sum.hex();
}

}  // namespace kontur::viewer
