// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace kontur {
namespace {

using Slices = std::vector<DicomHeader>;

constexpr double kSameDirection = 1e-4;

bool near(const Vec3& a, const Vec3& b) { return distance(a, b) <= kSameDirection; }

bool same_geometry(const DicomHeader& a, const DicomHeader& b) {
    if (std::tie(a.series_uid, a.rows, a.columns) != std::tie(b.series_uid, b.rows, b.columns)) return false;
    const SlicePlacement &p = a.placement, &q = b.placement;
    return near(p.row_direction, q.row_direction) && near(p.column_direction, q.column_direction) &&
           std::abs(p.spacing_mm[0] - q.spacing_mm[0]) <= kSameDirection * p.spacing_mm[0] &&
           std::abs(p.spacing_mm[1] - q.spacing_mm[1]) <= kSameDirection * p.spacing_mm[1];
}

std::vector<Slices> group_by_geometry(Slices headers) {
    std::vector<Slices> groups;
    for (DicomHeader& header : headers) {
        const auto found =
            std::find_if(groups.begin(), groups.end(), [&](const Slices& g) { return same_geometry(g.front(), header); });
        if (found != groups.end()) found->push_back(std::move(header));
        else groups.push_back({std::move(header)});
    }
    return groups;
}

template <typename Key>
std::map<Key, Slices> partition_by(Slices slices, Key DicomHeader::*key) {
    std::map<Key, Slices> parts;
    for (DicomHeader& slice : slices) parts[slice.*key].push_back(std::move(slice));
    return parts;
}

void sort_by_position(Slices& slices) {
    const Vec3 normal = slices.front().placement.normal();
    std::stable_sort(slices.begin(), slices.end(), [&](const DicomHeader& a, const DicomHeader& b) {
        return dot(normal, a.placement.position) < dot(normal, b.placement.position);
    });
}

/// The sorted slices cut into runs that lie at one position.
std::vector<Slices> runs_at_one_position(const Slices& sorted) {
    const std::vector<double> positions = positions_along_normal(sorted);
    std::vector<Slices> runs;
    for (std::size_t k = 0; k < sorted.size(); ++k) {
        if (k == 0 || positions[k] - positions[k - 1] > kSamePositionMm) runs.emplace_back();
        runs.back().push_back(sorted[k]);
    }
    return runs;
}

/// The r-th slice of every position forms stack r, if all positions have equally many and something orders them.
std::vector<DicomStack> split_by_rank(std::vector<Slices> runs) {
    const auto order = [](const DicomHeader& s) { return std::tie(s.trigger_time_ms, s.instance_number); };
    const std::size_t count = runs.front().size();
    if (runs.front().front().frame) return {};  // the order of frames in a file means nothing
    std::vector<DicomStack> stacks(count);
    for (Slices& run : runs) {
        std::sort(run.begin(), run.end(), [&](const auto& a, const auto& b) { return order(a) < order(b); });
        const bool tied = std::adjacent_find(run.begin(), run.end(), [&](const auto& a, const auto& b) {
                              return order(a) == order(b);
                          }) != run.end();
        if (run.size() != count || tied) return {};
        for (std::size_t r = 0; r < count; ++r) {
            stacks[r].slices.push_back(run[r]);
            stacks[r].distinction = fmt::format("time {} of {}", r + 1, count);
        }
    }
    return stacks;
}

std::vector<DicomStack> split_collisions(Slices slices);

std::string text_of(const std::string& value) { return value.empty() ? "not given" : value; }

template <class Number>
std::string text_of(const std::optional<Number>& value) {
    return value ? fmt::format("{}", *value) : "not given";
}

template <class Value>
std::vector<DicomStack> split_by_tag(const Slices& slices, std::size_t positions, std::string_view name,
                                     Value DicomHeader::*tag) {
    auto parts = partition_by(slices, tag);
    // A tag that differs from slice to slice tells nothing about volumes.
    const bool shatters = std::any_of(parts.begin(), parts.end(), [&](const auto& part) {
        return positions > 1 && runs_at_one_position(part.second).size() == 1;
    });
    if (parts.size() < 2 || shatters) return {};
    std::vector<DicomStack> stacks;
    for (auto& [value, part] : parts)
        for (DicomStack& stack : split_collisions(std::move(part))) {
            const std::string own = fmt::format("{} {}", name, text_of(value));
            stack.distinction = stack.distinction.empty() ? own : own + ", " + stack.distinction;
            stacks.push_back(std::move(stack));
        }
    return stacks;
}

/// By the first of these that sets volumes apart; the rest is tried on each part.
std::vector<DicomStack> split_by_tags(const Slices& slices, std::size_t positions) {
    std::vector<DicomStack> stacks;
    const auto split = [&](std::string_view name, auto tag) {
        if (stacks.empty()) stacks = split_by_tag(slices, positions, name, tag);
    };
    split("dose", &DicomHeader::dose);
    split("temporal position", &DicomHeader::temporal_position);
    split("echo", &DicomHeader::echo_number);
    split("echo time", &DicomHeader::echo_time_ms);
    split("b-value", &DicomHeader::b_value);
    split("frame type", &DicomHeader::frame_type);
    split("acquisition", &DicomHeader::acquisition_number);
    return stacks;
}

std::vector<DicomStack> split_collisions(Slices slices) {
    sort_by_position(slices);
    std::vector<Slices> runs = runs_at_one_position(slices);
    if (runs.size() < slices.size()) {
        if (auto stacks = split_by_tags(slices, runs.size()); !stacks.empty()) return stacks;
        if (auto stacks = split_by_rank(std::move(runs)); !stacks.empty()) return stacks;
    }
    return {DicomStack{std::move(slices), "", {}}};
}

/// Anonymisation may give every file a frame of reference of its own; such UIDs tell nothing and are set aside.
std::vector<DicomStack> split_by_frame_of_reference(Slices slices) {
    const std::size_t count = slices.size();
    auto frames = partition_by(slices, &DicomHeader::frame_of_reference_uid);
    const bool meaningless = count > 1 && frames.size() == count;
    std::vector<DicomStack> stacks;
    if (!meaningless) {
        for (auto& [uid, part] : frames)
            for (DicomStack& stack : split_collisions(std::move(part))) stacks.push_back(std::move(stack));
        return stacks;
    }
    stacks = split_collisions(std::move(slices));
    for (DicomStack& stack : stacks)
        stack.notes.push_back("every file names a frame of reference of its own; the slices are taken to share one");
    return stacks;
}

}  // namespace

std::vector<double> positions_along_normal(const std::vector<DicomHeader>& slices) {
    const SlicePlacement& first = slices.front().placement;
    std::vector<double> positions;
    positions.reserve(slices.size());
    for (const DicomHeader& slice : slices)
        positions.push_back(dot(first.normal(), slice.placement.position - first.position));
    return positions;
}

std::vector<DicomStack> group_into_stacks(std::vector<DicomHeader> headers) {
    std::stable_sort(headers.begin(), headers.end(),
                     [](const DicomHeader& a, const DicomHeader& b) { return a.series_uid < b.series_uid; });
    std::vector<DicomStack> stacks;
    for (Slices& group : group_by_geometry(std::move(headers)))
        for (DicomStack& stack : split_by_frame_of_reference(std::move(group))) stacks.push_back(std::move(stack));
    return stacks;
}

}  // namespace kontur
