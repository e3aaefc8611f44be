// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/components.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace kontur {
namespace {

/// Inside voxels [begin, end) that follow each other along i.
struct Run {
    std::int64_t begin, end;
};

/// Sets that only ever grow together; each is named by its first element.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

    std::size_t find(std::size_t item) {
        while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
        return item;
    }
    void join(std::size_t a, std::size_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::size_t> parent_;
};

struct RunList {
    std::vector<Run> runs;
    std::vector<std::size_t> row_start;  ///< first run of row j + size.j * k, and one end more
};

/// The first byte that is not 0; eight at a time, for most of a mask is empty.
const std::uint8_t* skip_zeros(const std::uint8_t* at, const std::uint8_t* end) {
    for (std::uint64_t eight = 0; end - at >= 8; at += 8) {
        std::memcpy(&eight, at, 8);
        if (eight != 0) break;
    }
    while (at < end && *at == 0) ++at;
    return at;
}

RunList find_runs(const Mask& mask) {
    const Index3 size = mask.grid.size;
    RunList list;
    for (std::int64_t row = 0; row < size.j * size.k; ++row) {
        list.row_start.push_back(list.runs.size());
        const std::uint8_t *values = mask.values.data() + row * size.i, *end = values + size.i;
        for (const std::uint8_t* at = skip_zeros(values, end); at < end;) {
            const auto* zero = static_cast<const std::uint8_t*>(std::memchr(at, 0, static_cast<std::size_t>(end - at)));
            const std::uint8_t* run_end = zero ? zero : end;
            list.runs.push_back({at - values, run_end - values});
            at = skip_zeros(run_end, end);
        }
    }
    list.row_start.push_back(list.runs.size());
    return list;
}

/// Joins the runs of two rows that share an i.
void join_rows(const RunList& list, std::int64_t row_a, std::int64_t row_b, DisjointSets& sets) {
    std::size_t a = list.row_start[row_a], b = list.row_start[row_b];
    while (a < list.row_start[row_a + 1] && b < list.row_start[row_b + 1]) {
        const Run &run_a = list.runs[a], &run_b = list.runs[b];
        if (run_a.begin < run_b.end && run_b.begin < run_a.end) sets.join(a, b);
        run_a.end < run_b.end ? ++a : ++b;
    }
}

}  // namespace

Components find_components(const Mask& mask) {
    check_mask(mask);
    const Index3 size = mask.grid.size;
    const RunList list = find_runs(mask);
    DisjointSets sets(list.runs.size());
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 0; j < size.j; ++j) {
            const std::int64_t row = j + size.j * k;
            if (j > 0) join_rows(list, row, row - 1, sets);
            if (k > 0) join_rows(list, row, row - size.j, sets);
        }

    std::vector<std::int64_t> voxels(list.runs.size());
    for (std::size_t r = 0; r < list.runs.size(); ++r) voxels[sets.find(r)] += list.runs[r].end - list.runs[r].begin;
    std::vector<std::size_t> firsts;  // the run that names each component
    for (std::size_t r = 0; r < list.runs.size(); ++r)
        if (voxels[r] > 0) firsts.push_back(r);
    std::stable_sort(firsts.begin(), firsts.end(), [&](std::size_t a, std::size_t b) { return voxels[a] > voxels[b]; });

    Components components;
    std::vector<std::size_t> number(list.runs.size());
    for (const std::size_t first : firsts) {
        number[first] = components.sizes.size();
        components.sizes.push_back(voxels[first]);
    }
    for (std::int64_t row = 0; row < size.j * size.k; ++row)
        for (std::size_t r = list.row_start[row]; r < list.row_start[row + 1]; ++r) {
            const Run& run = list.runs[r];
            components.runs.push_back({static_cast<std::size_t>(row * size.i + run.begin),
                                       static_cast<std::size_t>(row * size.i + run.end), number[sets.find(r)]});
        }
    return components;
}

std::vector<std::int64_t> component_sizes(const Mask& mask) { return find_components(mask).sizes; }

}  // namespace kontur
