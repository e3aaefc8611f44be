// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/deflate.h"
#include "kontur/io/images/nrrd.h"
#include "kontur/io/images/nrrd_text.h"

namespace kontur {
namespace {

constexpr std::int64_t kMostLabels = std::numeric_limits<std::uint16_t>::max();

/// As `segment_keys` wants it.
std::string extent_text(const Mask& mask) {
    const Index3& size = mask.grid.size;
    Index3 low = size, high{-1, -1, -1};
    std::size_t n = 0;
    for (Index3 at; at.k < size.k; ++at.k)
        for (at.j = 0; at.j < size.j; ++at.j)
            for (at.i = 0; at.i < size.i; ++at.i, ++n) {
                if (mask.values[n] == 0) continue;
                for (int axis = 0; axis < 3; ++axis) {
                    low[axis] = std::min(low[axis], at[axis]);
                    high[axis] = std::max(high[axis], at[axis]);
                }
            }
    if (high.i < 0) low = {};
    return fmt::format("{} {} {} {} {} {}", low.i, high.i, low.j, high.j, low.k, high.k);
}

/// Label maps, as few as there is room in.
template <typename Value>
class Layers {
public:
    /// The layer that a mask gets into: the first whose labels it does not touch.
    std::size_t add(const Mask& mask, std::int64_t label) {
        const auto has_room = [&](const std::vector<Value>& layer) {
            return std::equal(layer.begin(), layer.end(), mask.values.begin(),
                              [](Value there, std::uint8_t v) { return there == 0 || v == 0; });
        };
        auto layer = std::find_if(layers_.begin(), layers_.end(), has_room);
        if (layer == layers_.end()) layer = layers_.emplace(layers_.end(), mask.values.size());
        for (std::size_t n = 0; n < mask.values.size(); ++n)
            if (mask.values[n] != 0) (*layer)[n] = static_cast<Value>(label);
        return static_cast<std::size_t>(layer - layers_.begin());
    }

    std::size_t count() const { return layers_.size(); }

    /// The values of all layers, voxel by voxel.
    void write(Deflater& deflater) const {
        constexpr std::size_t kVoxels = 65536;
        std::vector<Value> values;
        for (std::size_t begin = 0; begin < layers_[0].size(); begin += kVoxels) {
            values.clear();
            for (std::size_t n = begin; n < std::min(begin + kVoxels, layers_[0].size()); ++n)
                for (const std::vector<Value>& layer : layers_) values.push_back(layer[n]);
            deflater.write(std::as_bytes(std::span(values)));
        }
    }

private:
    std::vector<std::vector<Value>> layers_;
};

template <typename Value>
void write_layers(const std::filesystem::path& path, std::span<const Mask> masks, std::vector<NrrdSegment> segments,
                  const Provenance& provenance) {
    Layers<Value> layers;
    std::string keys = segmentation_keys();
    for (std::size_t n = 0; n < masks.size(); ++n) {
        segments[n].layer = static_cast<std::int64_t>(layers.add(masks[n], segments[n].label_value));
        keys += segment_keys(n, segments[n], extent_text(masks[n]));
    }
    const char* type = std::is_same_v<Value, std::uint8_t> ? "uint8" : "uint16";
    write_file_atomically(path, [&](AtomicFile& file) {
        file.write(nrrd_header_text(masks[0].grid, type, layers.count(), provenance) + keys + "\n");
        Deflater deflater(
            DeflateFormat::gzip, [&](const void* data, std::size_t count) { file.write(data, count); },
            sizeof(Value) == 1 ? DeflateMode::runs : DeflateMode::dense);
        layers.write(deflater);
        deflater.finish();
    });
}

std::int64_t largest_label(const std::vector<NrrdSegment>& segments) {
    return std::ranges::max(segments, {}, &NrrdSegment::label_value).label_value;
}

/// With their own labels where these tell them apart, else with 1, 2, ...
std::vector<NrrdSegment> with_labels(std::vector<NrrdSegment> segments) {
    std::set<std::int64_t> labels;
    for (const NrrdSegment& segment : segments) labels.insert(segment.label_value);
    if (labels.size() == segments.size() && *labels.begin() >= 1 && *labels.rbegin() <= kMostLabels) return segments;
    for (std::size_t n = 0; n < segments.size(); ++n) segments[n].label_value = static_cast<std::int64_t>(n + 1);
    return segments;
}

void check_masks(std::span<const Mask> masks, std::span<const NrrdSegment> segments) {
    const auto refuse = [](const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); };
    if (masks.empty() || masks.size() != segments.size())
        refuse(fmt::format("there are {} for {}; as many are needed, and 1 at least", counted(masks.size(), "mask"),
                           counted(segments.size(), "segment")));
    if (masks.size() > kMostLabels)
        refuse(fmt::format("there are {} segments; a .seg.nrrd has room for {}", masks.size(), kMostLabels));
    for (const Mask& mask : masks) {
        check_mask(mask);
        if (!(mask.grid == masks[0].grid)) refuse("the masks lie on different grids; one is needed");
    }
    for (const NrrdSegment& segment : segments) check_utf8(segment.name, "the segment's name");
}

}  // namespace

void write_seg_nrrd_masks(const std::filesystem::path& path, std::span<const Mask> masks,
                          std::span<const NrrdSegment> segments, const Provenance& provenance) {
    check_masks(masks, segments);
    const std::vector<NrrdSegment> labelled = with_labels({segments.begin(), segments.end()});
    const auto write = largest_label(labelled) <= 255 ? write_layers<std::uint8_t> : write_layers<std::uint16_t>;
    write(path, masks, labelled, provenance);
}

}  // namespace kontur
