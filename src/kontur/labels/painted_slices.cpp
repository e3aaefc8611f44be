// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/painted_slices.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <utility>

#include "kontur/labels/painted_runs.h"

namespace kontur {
namespace {

// One more bit of what is known of a voxel: it is explained by a slice.
constexpr std::uint8_t kExplained = 8;
static_assert((kExplained & (kShortest | kSolid)) == 0);

class SliceSearch {
public:
    explicit SliceSearch(const Mask& mask) : size_(mask.grid.size), known_(shortest_runs(mask)) {}

    std::vector<PaintedSlice> slices() {
        count_votes();
        if (is_mostly_solid()) main_axis_alone();
        else take_slices();
        take_what_is_left();
        std::vector<PaintedSlice> slices;
        for (auto& [key, slice] : taken_) {
            slice.whole =
                std::equal(slice.section.begin(), slice.section.end(), painted_in(slice.axis, slice.index).begin());
            slices.push_back(std::move(slice));
        }
        return slices;
    }

private:
    /// A slice's position and number of voxels that count for it.
    struct Candidate {
        std::int64_t votes;
        int axis;
        std::int64_t index;
        bool operator<(const Candidate& other) const {  // of equal ones the last axis, then the first slice, comes first
            return std::tuple(votes, axis, -index) < std::tuple(other.votes, other.axis, -other.index);
        }
    };

    std::size_t offset(int axis, std::int64_t index, std::int64_t a, std::int64_t b) const {
        Index3 at;
        const auto [u, v] = slice_axes(axis);
        at[axis] = index, at[u] = a, at[v] = b;
        return static_cast<std::size_t>(at.i + size_.i * (at.j + size_.j * at.k));
    }

    /// Calls visit(place in the slice, offset in the grid) for all voxels of a slice.
    template <class Visit>
    void for_slice(int axis, std::int64_t index, const Visit& visit) const {
        const auto [u, v] = slice_axes(axis);
        std::size_t place = 0;
        for (std::int64_t b = 0; b < size_[v]; ++b)
            for (std::int64_t a = 0; a < size_[u]; ++a) visit(place++, offset(axis, index, a, b));
    }

    std::vector<std::uint8_t> painted_in(int axis, std::int64_t index) const {
        std::vector<std::uint8_t> painted;
        for_slice(axis, index, [&](std::size_t, std::size_t n) { painted.push_back(known_[n] != 0); });
        return painted;
    }

    /// The axis for which a voxel counts; -1 for none: it isn't painted, or several are as short. Solids may be cut along
    /// any axis: along the one of the label's other slices.
    int vote(std::uint8_t bits) const {
        if (bits & kSolid && main_axis_ >= 0) return main_axis_;
        switch (bits & kShortest) {
            case 1:
                return 0;
            case 2:
                return 1;
            case 4:
                return 2;
            default:
                return -1;
        }
    }

    void count_votes() {
        count_all();
        std::array<std::int64_t, 3> sums{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            sums[axis] = std::accumulate(votes_[axis].begin(), votes_[axis].end(), std::int64_t{0});
        main_axis_ = 2;
        for (const int axis : {1, 0})
            if (sums[static_cast<std::size_t>(axis)] > sums[static_cast<std::size_t>(main_axis_)]) main_axis_ = axis;
        count_all();
    }

    void count_all() {
        for (int axis = 0; axis < 3; ++axis) votes_[axis].assign(static_cast<std::size_t>(size_[axis]), 0);
        for (std::int64_t k = 0, n = 0; k < size_.k; ++k)
            for (std::int64_t j = 0; j < size_.j; ++j)
                for (std::int64_t i = 0; i < size_.i; ++i, ++n) count(n, {i, j, k}, 1);
    }

    void count(std::int64_t n, const Index3& at, int by) {
        if (const int axis = vote(known_[static_cast<std::size_t>(n)]); axis >= 0)
            votes_[axis][static_cast<std::size_t>(at[axis])] += by;
    }

    bool is_mostly_solid() const {
        const auto painted = std::count_if(known_.begin(), known_.end(), [](std::uint8_t bits) { return bits != 0; });
        return 2 * std::count_if(known_.begin(), known_.end(), [](std::uint8_t bits) { return bits & kSolid; }) > painted;
    }

    /// Where most is solid, thin ends of it are no slices of other directions.
    void main_axis_alone() {
        for (std::uint8_t& bits : known_)
            if (bits) bits = static_cast<std::uint8_t>(1 << main_axis_);
    }

    void take_slices() {
        std::priority_queue<Candidate> queue;
        for (int axis = 0; axis < 3; ++axis)
            for (std::int64_t index = 0; index < size_[axis]; ++index)
                if (const std::int64_t votes = votes_[axis][static_cast<std::size_t>(index)]; votes > 0)
                    queue.push({votes, axis, index});
        while (!queue.empty()) {
            Candidate best = queue.top();
            queue.pop();
            const std::int64_t votes = votes_[best.axis][static_cast<std::size_t>(best.index)];
            if (votes == 0) continue;
            if (votes < best.votes) {  // others have explained some of them since
                best.votes = votes;
                queue.push(best);
                continue;
            }
            take(best.axis, best.index);
        }
    }

    void take(int axis, std::int64_t index) {
        PaintedSlice& slice = taken_[{axis, index}];
        slice.axis = axis, slice.index = index;
        const std::vector<std::uint8_t> painted = painted_in(axis, index);
        slice.section.assign(painted.size(), 0);
        std::vector<std::int64_t> thicknesses;
        for_slice(axis, index, [&](std::size_t place, std::size_t n) {
            if (vote(known_[n]) != axis) return;
            slice.section[place] = 1;
            thicknesses.push_back(thickness(axis, index, n));
        });
        const auto middle = thicknesses.begin() + static_cast<std::ptrdiff_t>(thicknesses.size() / 2);
        std::nth_element(thicknesses.begin(), middle, thicknesses.end());
        grow(slice, painted, *middle + 1);  // one more for tips that end in the trace of another slice
        fill_between(slice, painted);
        explain(slice);
    }

    /// How many voxels are painted one behind the other through a voxel of a slice.
    std::int64_t thickness(int axis, std::int64_t index, std::size_t n) const {
        const std::int64_t stride = axis == 0 ? 1 : axis == 1 ? size_.i : size_.i * size_.j;
        std::int64_t low = index, high = index;
        const auto at = [&](std::int64_t where) {
            return known_[static_cast<std::size_t>(static_cast<std::int64_t>(n) + (where - index) * stride)];
        };
        while (low > 0 && at(low - 1)) --low;
        while (high + 1 < size_[axis] && at(high + 1)) ++high;
        return high - low + 1;
    }

    /// Adds what is painted and connected with the section by no more than `steps` steps.
    void grow(PaintedSlice& slice, const std::vector<std::uint8_t>& painted, std::int64_t steps) const {
        const std::int64_t width = size_[slice_axes(slice.axis)[0]],
                           height = static_cast<std::int64_t>(painted.size()) / width;
        std::vector<std::int64_t> front, next;
        for (std::size_t n = 0; n < painted.size(); ++n)
            if (slice.section[n]) front.push_back(static_cast<std::int64_t>(n));
        const auto reach = [&](std::int64_t place) {
            const auto n = static_cast<std::size_t>(place);
            if (painted[n] && !slice.section[n]) slice.section[n] = 1, next.push_back(place);
        };
        for (std::int64_t step = 0; step < steps && !front.empty(); ++step, front.swap(next), next.clear())
            for (const std::int64_t place : front) {
                const std::int64_t a = place % width, b = place / width;
                if (a > 0) reach(place - 1);
                if (a + 1 < width) reach(place + 1);
                if (b > 0) reach(place - width);
                if (b + 1 < height) reach(place + width);
            }
    }

    /// Adds what is painted between two voxels of the section without a gap: slices of other directions that cross it.
    void fill_between(PaintedSlice& slice, const std::vector<std::uint8_t>& painted) const {
        const std::int64_t width = size_[slice_axes(slice.axis)[0]],
                           height = static_cast<std::int64_t>(painted.size()) / width;
        const auto fill_row = [&](std::int64_t first, std::int64_t count, std::int64_t stride) {
            std::int64_t last = -1;  // of the section in this run
            for (std::int64_t n = 0; n < count; ++n) {
                const auto place = static_cast<std::size_t>(first + n * stride);
                if (!painted[place]) last = -1;
                if (!slice.section[place]) continue;
                if (last >= 0)
                    for (std::int64_t m = last + 1; m < n; ++m)
                        slice.section[static_cast<std::size_t>(first + m * stride)] = 1;
                last = n;
            }
        };
        for (std::int64_t b = 0; b < height; ++b) fill_row(b * width, width, 1);
        for (std::int64_t a = 0; a < width; ++a) fill_row(a, height, width);
    }

    void explain(const PaintedSlice& slice) {
        for_slice(slice.axis, slice.index, [&](std::size_t place, std::size_t n) {
            if (!slice.section[place] || known_[n] & kExplained) return;
            const auto m = static_cast<std::int64_t>(n);
            count(m, {m % size_.i, m / size_.i % size_.j, m / (size_.i * size_.j)}, -1);
            known_[n] |= kExplained;
        });
    }

    /// Voxels whose runs are equally short and that no slice has reached, such as single ones, go to the main axis if they
    /// may, or if they lie beside a slice across it.
    void take_what_is_left() {
        const int a = main_axis_;
        const std::array<int, 3> order{a, a == 2 ? 1 : 2, a == 0 ? 1 : 0};
        for (std::int64_t k = 0, n = 0; k < size_.k; ++k)
            for (std::int64_t j = 0; j < size_.j; ++j)
                for (std::int64_t i = 0; i < size_.i; ++i, ++n) {
                    const std::uint8_t bits = known_[static_cast<std::size_t>(n)];
                    if (bits == 0 || bits & kExplained) continue;
                    const Index3 at{i, j, k};
                    const bool beside = is_in_section(at, -1) || is_in_section(at, 1);
                    add_voxel(beside ? main_axis_
                                     : *std::find_if(order.begin(), order.end(), [&](int axis) { return bits >> axis & 1; }),
                              at);
                }
    }

    /// Whether the voxel so many steps along the main axis lies in the section of a slice across it.
    bool is_in_section(Index3 at, std::int64_t steps) const {
        at[main_axis_] += steps;
        const auto slice = taken_.find({main_axis_, at[main_axis_]});
        const auto [u, v] = slice_axes(main_axis_);
        return slice != taken_.end() && slice->second.section[static_cast<std::size_t>(at[u] + size_[u] * at[v])];
    }

    void add_voxel(int axis, const Index3& at) {
        const auto [u, v] = slice_axes(axis);
        PaintedSlice& slice = taken_[{axis, at[axis]}];
        slice.axis = axis, slice.index = at[axis];
        slice.section.resize(static_cast<std::size_t>(size_[u] * size_[v]));
        slice.section[static_cast<std::size_t>(at[u] + size_[u] * at[v])] = 1;
    }

    Index3 size_;
    std::vector<std::uint8_t> known_;
    int main_axis_ = -1;  ///< for which most voxels count
    std::array<std::vector<std::int64_t>, 3> votes_;
    std::map<std::pair<int, std::int64_t>, PaintedSlice> taken_;
};

}  // namespace

std::array<int, 2> slice_axes(int axis) { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }

std::vector<PaintedSlice> find_painted_slices(const Mask& mask) {
    check_mask(mask);
    return SliceSearch(mask).slices();
}

}  // namespace kontur
