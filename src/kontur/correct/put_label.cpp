// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/put_label.h"

#include <fmt/format.h>

#include <map>
#include <type_traits>
#include <variant>

#include "kontur/base/error.h"
#include "kontur/correct/ceded_voxels.h"

namespace kontur {
namespace {

/// Of a voxel of a map: the label that it gets.
struct GivenVoxel {
    std::size_t offset;
    std::int64_t label;
};

std::int64_t label_at(const Image& labels, std::size_t offset) { return static_cast<std::int64_t>(sample(labels, offset)); }

void check(const Image& labels, const LabelChange& change) {
    check_image(labels);
    check_mask(change.before, "the mask before");
    check_mask(change.after, "the mask after");
    if (labels.grid != change.before.grid || labels.grid != change.after.grid)
        throw Error(ErrorKind::invalid_input, "the label map and the masks before and after have 2 or 3 grids; 1 is needed");
    std::visit(
        [&]<class Value>(const std::vector<Value>&) {
            const auto value = static_cast<Value>(change.label);
            if (static_cast<std::int64_t>(value) != change.label)
                throw Error(ErrorKind::invalid_input,
                            fmt::format("the map's values have no room for the label {}", change.label));
        },
        labels.samples);
}

/// What the label loses where it touched others.
std::vector<GivenVoxel> given_voxels(const Image& labels, const LabelChange& change, const Work& work) {
    std::vector<GivenVoxel> given;
    for (const CededVoxel& voxel : ceded_voxels(change.before, change.after, work))
        if (const std::int64_t label = label_at(labels, voxel.neighbor); label != 0) given.push_back({voxel.offset, label});
    return given;
}

std::vector<PassedVoxels> passed_voxels(const Image& labels, const LabelChange& change,
                                        const std::vector<GivenVoxel>& given) {
    std::map<std::int64_t, std::size_t> lost, gained;
    for (std::size_t n = 0; n < change.after.values.size(); ++n) {
        if (change.after.values[n] == 0) continue;
        if (const std::int64_t label = label_at(labels, n); label != 0 && label != change.label) ++lost[label];
    }
    for (const GivenVoxel& voxel : given) ++gained[voxel.label];
    std::vector<PassedVoxels> passed;
    for (const auto& [label, count] : lost) passed.push_back({label, change.label, count});
    for (const auto& [label, count] : gained) passed.push_back({change.label, label, count});
    return passed;
}

}  // namespace

PutLabel put_label(Image labels, const LabelChange& change, bool shared_borders, const Work& work) {
    check(labels, change);
    std::vector<GivenVoxel> given;
    if (shared_borders) given = given_voxels(labels, change, work);
    PutLabel put{std::move(labels), {}};
    put.passed = passed_voxels(put.labels, change, given);
    std::visit(
        [&]<class Value>(std::vector<Value>& samples) {
            for (std::size_t n = 0; n < samples.size(); ++n) {
                if (change.after.values[n] != 0) samples[n] = static_cast<Value>(change.label);
                else if (change.before.values[n] != 0) samples[n] = 0;
            }
            for (const GivenVoxel& voxel : given) samples[voxel.offset] = static_cast<Value>(voxel.label);
        },
        put.labels.samples);
    return put;
}

}  // namespace kontur
