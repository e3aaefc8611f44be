// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/voxel_walk.h"

#include <algorithm>
#include <cmath>

#include "kontur/image/local_looks.h"
#include "kontur/image/random_walk.h"
#include "kontur/sampling/place_in_turn.h"

namespace kontur {
namespace {

constexpr double kTolerance = 1e-3;
constexpr double kTie = 0.3;           // of a cell to what is known of it alone, beside its steps
constexpr double kReach = 3;           // half the band's width in standard deviations ...
constexpr double kLeastReach = 0.8;    // ... and cells more ...
constexpr double kMostReach = 15;      // ... but no more than so many mm
constexpr double kLeastDeviation = 1;  // cells
constexpr double kLooks = 0.12;        // of the drawing's diameter: how far examples of looks reach
constexpr double kLooksWeight = 1.5;

class Walker {
public:
    Walker(const ImageCells& cells, const CellDepths& depths, const WalkOptions& options)
        : cells_(cells), depths_(depths), options_(options), number_(cells.looks.size(), WalkPlace::kNowhere) {
        walk_.inside.resize(cells.looks.size());
        for (std::size_t n = 0; n < walk_.inside.size(); ++n) walk_.inside[n] = depths.is_inside(n);
    }

    VoxelWalk walk(const Work& work) {
        find_band();
        if (walk_.band.empty()) return std::move(walk_);
        work.check();
        const LocalLooks looks = looks_of_planes();
        work.check();
        const std::vector<double> inside = walk_inside(places(looks), kTolerance, work);
        for (std::size_t n = 0; n < inside.size(); ++n) walk_.inside[walk_.band[n]] = static_cast<float>(inside[n]);
        for (const bool side : {true, false}) leave_out_islands(side);
        return std::move(walk_);
    }

private:
    bool is_in_band(std::size_t cell) const { return number_[cell] != WalkPlace::kNowhere; }

    void find_band() {
        const std::array<Vec3, 3> half_edges = cells_.half_edges();
        const double least = kLeastReach * cells_.edge_mm();
        for (std::size_t n = 0; n < number_.size(); ++n) {
            const double depth = std::abs(static_cast<double>(depths_.depth_mm[n]));
            if (depth > kMostReach || !std::isfinite(cells_.looks[n])) continue;
            const Vec3 p = cells_.center(n);
            if (options_.walls.is_in_plane(p, half_edges)) {
                examples_.push_back(n);
            } else if (depth <= kReach * options_.prior_mm(static_cast<double>(depths_.far_mm[n])) + least &&
                       options_.near.holds(p) && !options_.walls.is_beyond_end(p)) {
                number_[n] = static_cast<std::int32_t>(walk_.band.size());
                walk_.band.push_back(static_cast<std::uint32_t>(n));
            }
        }
    }

    LocalLooks looks_of_planes() const {
        std::vector<LookExample> some;
        const double share = kLookExamples / static_cast<double>(examples_.size());
        for (const std::size_t n : examples_)
            if (place_in_turn(cells_.index(n)) < share)
                some.push_back({cells_.center(n), cells_.looks[n], depths_.is_inside(n)});
        std::vector<Vec3> centers;
        for (const std::uint32_t cell : walk_.band) centers.push_back(cells_.center(cell));
        return {std::move(some), kLooks * options_.diameter_mm, cells_.grid, centers};
    }

    float step(std::size_t from, std::size_t to) const {
        const float apart = cells_.looks[from] - cells_.looks[to];
        if (!std::isfinite(apart)) return static_cast<float>(kLeastStepWeight);
        return std::exp(-static_cast<float>(kLookContrast) * apart * apart) + static_cast<float>(kLeastStepWeight);
    }

    /// How likely a cell is inside by its depth and its look alone.
    double likely(std::size_t cell, const LocalLooks& looks) const {
        const double deviation =
            std::max(options_.prior_mm(static_cast<double>(depths_.far_mm[cell])), kLeastDeviation * cells_.edge_mm());
        const double odds = kLogistic * static_cast<double>(depths_.depth_mm[cell]) / deviation +
                            kLooksWeight * looks.log_odds(cells_.center(cell), cells_.looks[cell]);
        return 1 / (1 + std::exp(-odds));
    }

    std::vector<WalkPlace> places(const LocalLooks& looks) const {
        std::vector<WalkPlace> places;
        for (const std::uint32_t cell : walk_.band) {
            WalkPlace place;
            place.ends = kTie;
            place.ends_inside = kTie * likely(cell, looks);
            cells_.visit_neighbours(cell, [&](int side, std::size_t next) {
                const float weight = step(cell, next);
                if (is_in_band(next)) {
                    place.next[static_cast<std::size_t>(side)] = number_[next];
                    place.weight[static_cast<std::size_t>(side)] = weight;
                } else {
                    place.ends += static_cast<double>(weight);
                    if (depths_.is_inside(next)) place.ends_inside += static_cast<double>(weight);
                }
            });
            places.push_back(place);
        }
        return places;
    }

    /// Gives to the other side what no seed of its own is connected with.
    void leave_out_islands(bool side) {
        std::vector<std::uint8_t> is_reached(number_.size());
        std::vector<std::size_t> front;
        const auto reach = [&](std::size_t cell) {
            if (walk_.is_inside(cell) != side || is_reached[cell]) return;
            is_reached[cell] = 1;
            front.push_back(cell);
        };
        for (const std::uint32_t cell : walk_.band)
            cells_.visit_neighbours(cell, [&](int, std::size_t next) {
                if (!is_in_band(next)) reach(next);
            });
        while (!front.empty()) {
            const std::size_t cell = front.back();
            front.pop_back();
            cells_.visit_neighbours(cell, [&](int, std::size_t next) {
                if (is_in_band(next)) reach(next);
            });
        }
        for (const std::uint32_t cell : walk_.band)
            if (walk_.is_inside(cell) == side && !is_reached[cell]) walk_.inside[cell] = 1 - walk_.inside[cell];
    }

    const ImageCells& cells_;
    const CellDepths& depths_;
    const WalkOptions& options_;
    std::vector<std::int32_t> number_;   // of each cell in the band
    std::vector<std::size_t> examples_;  // cells in drawn planes
    VoxelWalk walk_;
};

}  // namespace

VoxelWalk walk_voxels(const ImageCells& cells, const CellDepths& depths, const WalkOptions& options, const Work& work) {
    return Walker(cells, depths, options).walk(work);
}

}  // namespace kontur
