// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/slice_edges.h"

#include <algorithm>
#include <cmath>

namespace kontur::viewer {
namespace {

constexpr int kSidePixels = 768;  ///< of a slice; a path's ends lie within its middle
constexpr int kMiddlePixels = 192;
constexpr std::size_t kMostSlices = 4;
constexpr std::size_t kMostWires = 4;  ///< seeds kept of one slice

bool is_same(const Plane& a, const Plane& b) { return a.u == b.u && a.v == b.v && std::abs(a.distance_to(b.origin)) < 1e-6; }

}  // namespace

struct SliceEdges::Slice {
    Slice(int its_number, const Image& image, const Plane& its_plane, const Vec3& around)
        : number(its_number),
          plane(its_plane),
          raster(centered_reslice(its_plane, kSidePixels, kSidePixels, smallest(image.grid.spacing_mm()))) {
        const double pixel_mm = raster.pixel_mm;
        // The lattice stays the same whatever point of the plane comes first: its nodes are multiples of a pixel from the
        // projection of the frame's origin.
        const auto [s, t] = raster.plane.to_uv(around);
        const auto [s0, t0] = raster.plane.to_uv({});
        const auto on_lattice = [&](double x, double x0) {
            return x0 + std::round((x - x0) / pixel_mm - 0.5 * kSidePixels) * pixel_mm;
        };
        raster.plane.origin = raster.plane.from_uv(on_lattice(s, s0), on_lattice(t, t0));
        const float outside = static_cast<float>(sample(image, 0));
        edges = std::make_unique<EdgeMap>(reslice(image, raster, outside), raster.width, raster.height);
    }

    Pixel pixel(const Vec3& p) const {
        const auto [s, t] = raster.plane.to_uv(p);
        const auto rounded = [&](double x) {
            return static_cast<int>(std::lround(std::clamp(x / raster.pixel_mm, -1.0, 1e6)));
        };
        return {rounded(s), rounded(t)};
    }

    Vec3 point(const PixelPosition& p) const { return raster.plane.from_uv(p[0] * raster.pixel_mm, p[1] * raster.pixel_mm); }

    bool has_in_the_middle(const Vec3& p) const {
        const Pixel at = pixel(p);
        return std::max(std::abs(at.column - kSidePixels / 2), std::abs(at.row - kSidePixels / 2)) <= kMiddlePixels;
    }

    LiveWire& wire(Pixel seed) {
        const auto known = std::find_if(wires.begin(), wires.end(), [&](const LiveWire& w) { return w.seed() == seed; });
        if (known != wires.end()) {
            wires.splice(wires.begin(), wires, known);
        } else {
            wires.emplace_front(*edges, seed);
            if (wires.size() > kMostWires) wires.pop_back();
        }
        return wires.front();
    }

    int number;  ///< of the image
    Plane plane;
    Reslice raster;
    std::unique_ptr<const EdgeMap> edges;
    std::list<LiveWire> wires;
};

SliceEdges::SliceEdges(std::shared_ptr<const Image> image) : images_{{0, std::move(image)}} {}
SliceEdges::~SliceEdges() = default;

void SliceEdges::set_further(int image, std::shared_ptr<const Image> further) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(slices_, [&](const Slice& slice) { return slice.number == image; });
    if (further) images_[image] = std::move(further);
    else images_.erase(image);
}

SliceEdges::Slice& SliceEdges::slice_of(const Plane& plane, const Vec3& point, int image) {
    const int number = images_.contains(image) ? image : 0;
    const auto known = std::find_if(slices_.begin(), slices_.end(), [&](const Slice& slice) {
        return slice.number == number && is_same(slice.plane, plane) && slice.has_in_the_middle(point);
    });
    if (known != slices_.end()) {
        slices_.splice(slices_.begin(), slices_, known);
    } else {
        slices_.emplace_front(number, *images_.at(number), plane, point);
        if (slices_.size() > kMostSlices) slices_.pop_back();
    }
    return slices_.front();
}

std::vector<Vec3> SliceEdges::path(const Plane& plane, const Vec3& from, const Vec3& to, int image) {
    const std::scoped_lock lock(mutex_);
    Slice& slice = slice_of(plane, from, image);
    const std::vector<Pixel> pixels = slice.wire(slice.pixel(from)).path_to(slice.pixel(to));
    std::vector<Vec3> line{from};
    const std::vector<PixelPosition> smooth = smooth_path(*slice.edges, pixels);
    for (std::size_t i = 1; i + 1 < smooth.size(); ++i) line.push_back(slice.point(smooth[i]));
    return line;
}

Vec3 SliceEdges::snap(const Plane& plane, const Vec3& point, double radius_mm, int image) {
    const std::scoped_lock lock(mutex_);
    const Slice& slice = slice_of(plane, point, image);
    const Pixel pixel = slice.pixel(point);
    const int radius = static_cast<int>(std::clamp(radius_mm / slice.raster.pixel_mm, 1.0, 20.0));
    const Pixel edge = slice.edges->snap(pixel, radius);
    // Where there is no edge the point stays where the user put it, not at the pixel's centre.
    if (slice.edges->strength(edge) == 0 || (edge == pixel && slice.edges->strength(edge) < 0.2)) return point;
    return slice.point(slice.edges->subpixel_position(edge));
}

}  // namespace kontur::viewer
