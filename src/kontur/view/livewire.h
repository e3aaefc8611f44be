// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// A pixel of a slice, or a position between pixel centres.
struct Pixel {
    int column = 0, row = 0;
    friend bool operator==(const Pixel&, const Pixel&) = default;
};
using PixelPosition = std::array<double, 2>;  ///< column, row

/// How well each pixel of a slice lies on an edge, and which way the edge runs: gradient of the slice smoothed over about
/// a pixel, in multiples of what its noise gives, so that a faint organ border counts like bone once it is clear of the
/// noise.
class EdgeMap {
public:
    /// `values`: width * height samples, row after row; at least 3 x 3, else Error(invalid_input). Linear in the pixels.
    EdgeMap(std::span<const float> values, int width, int height);

    int width() const { return width_; }
    int height() const { return height_; }
    bool contains(Pixel p) const { return p.column >= 0 && p.column < width_ && p.row >= 0 && p.row < height_; }

    /// 0 (no edge) to 1 (clear edge).
    double strength(Pixel p) const { return strength_[offset(p)]; }

    /// Cost of the step from a pixel to one of its 8 neighbours, 1 to kMostCost: low along edges.
    int cost(Pixel from, Pixel to) const;
    static constexpr int kMostCost = 600;

    /// The strongest edge pixel within `radius` pixels, nearer ones preferred; the pixel itself where there is no edge.
    Pixel snap(Pixel p, int radius) const;

    /// The edge's position to a fraction of a pixel: the gradient's maximum across the edge. The pixel's centre elsewhere.
    PixelPosition subpixel_position(Pixel p) const;

private:
    std::size_t offset(Pixel p) const {
        return static_cast<std::size_t>(p.row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(p.column);
    }
    double magnitude_at(double column, double row) const;
    void find_ridges();

    int width_, height_;
    std::vector<std::array<double, 2>> across_;  ///< unit gradient
    std::vector<float> magnitude_;
    std::vector<float> strength_;
    std::vector<float> shift_;         ///< along `across_` to the edge, for ridge pixels
    std::vector<std::uint8_t> ridge_;  ///< 1: the gradient is largest here across the edge
};

/// Cheapest paths along edges from one seed (Mortensen and Barrett 1995): Dijkstra's search with a bucket queue. It runs
/// only as far as the asked targets need and goes on from there with the next one. Pixels farther than `reach` from the seed
/// along a row or column are not searched.
class LiveWire {
public:
    /// `edges` must outlive the object. Throws Error(invalid_input) for a seed outside of the slice and a reach below 0.
    LiveWire(const EdgeMap& edges, Pixel seed, int reach = 256);

    Pixel seed() const { return seed_; }

    /// Pixels from the seed to the target, both included; a target beyond the slice or the reach is moved to its border.
    std::vector<Pixel> path_to(Pixel target);

private:
    static constexpr std::uint8_t kUnknown = 255;

    std::size_t offset(Pixel p) const;
    Pixel clamped(Pixel p) const;
    void search_until(Pixel target);
    void settle(std::uint32_t at);

    const EdgeMap& edges_;
    Pixel seed_;
    Pixel first_, last_;  ///< the searched window
    int window_width_ = 0;
    std::vector<std::uint32_t> distance_;
    std::vector<std::uint8_t> parent_;  ///< direction that the path came by
    std::vector<bool> settled_;
    std::vector<std::vector<std::uint32_t>> buckets_;  ///< circular: queued pixels by distance
    std::uint32_t reached_ = 0;                        ///< distance up to which all is settled
    std::size_t queued_ = 0;
};

/// The path as a line: moved to the edge between the pixels, and smoothed over a pixel or two; the ends stay at the
/// pixels' (subpixel) positions.
std::vector<PixelPosition> smooth_path(const EdgeMap& edges, std::span<const Pixel> path);

}  // namespace kontur
