// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/plane_look.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/parallel.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

constexpr int kStride = 3;  // pixels from one that is looked at first to the next

/// A pixel whose value is to be found.
struct OpenPixel {
    Sheet* sheet;
    std::size_t pixel;
    Vec3 place;
};

void answer(std::vector<OpenPixel>& open, const PlaceValues& values) {
    if (open.empty()) return;
    std::vector<Vec3> places;
    places.reserve(open.size());
    for (const OpenPixel& one : open) places.push_back(one.place);
    std::vector<double> samples(places.size());
    values(places, samples);
    for (std::size_t n = 0; n < open.size(); ++n) open[n].sheet->values[open[n].pixel] = samples[n];
    open.clear();
}

/// Of a block of kStride x kStride pixels between four that have been looked at.
class Blocks {
public:
    explicit Blocks(PlaneLook& look) : look_(look), sheet_(look.near()) {}

    static bool is_corner(int column, int row, const PixelLattice& lattice) {
        const auto on_grid = [](int n, int count) { return n % kStride == 0 || n + 1 == count; };
        return on_grid(column, lattice.columns) && on_grid(row, lattice.rows);
    }

    /// Gives each block whose corners and pixels agree its corners' value, and asks for all pixels of the others.
    void ask_or_infer(std::vector<OpenPixel>& open) {
        const PixelLattice& lattice = sheet_.lattice;
        for (int row = 0; row + 1 < lattice.rows; row += kStride)
            for (int column = 0; column + 1 < lattice.columns; column += kStride) {
                const int right = std::min(column + kStride, lattice.columns - 1),
                          top = std::min(row + kStride, lattice.rows - 1);
                const bool is_even = agrees(column, row, right, top);
                const double value = sheet_.values[lattice.index(column, row)];
                for (int j = row; j <= top; ++j)
                    for (int i = column; i <= right; ++i) settle(lattice.index(i, j), is_even, value, open);
            }
    }

private:
    bool agrees(int left, int bottom, int right, int top) const {
        const PixelLattice& lattice = sheet_.lattice;
        const bool inside = sheet_.values[lattice.index(left, bottom)] > 0;
        for (const int j : {bottom, top})
            for (const int i : {left, right})
                if ((sheet_.values[lattice.index(i, j)] > 0) != inside) return false;
        for (int j = bottom; j <= top; ++j)
            for (int i = left; i <= right; ++i)
                if ((sheet_.filled[lattice.index(i, j)] != 0) != inside) return false;
        return true;
    }

    void settle(std::size_t pixel, bool is_even, double value, std::vector<OpenPixel>& open) {
        double& here = sheet_.values[pixel];
        if (!std::isnan(here) && !std::isinf(here)) return;
        if (is_even) {
            if (std::isnan(here)) here = value;
            return;
        }
        // A pixel that another block has inferred stays; one that is asked for is marked so that it is asked for once.
        if (std::isinf(here)) return;
        here = std::numeric_limits<double>::infinity();
        open.push_back({&sheet_, pixel, look_.plane().from_uv(sheet_.lattice.at(pixel))});
    }

    PlaneLook& look_;
    Sheet& sheet_;
};

/// Deep wrong pixels, unless there are so many that no error of interpolation made them.
void ask_again(PlaneLook& look, Sheet& sheet, double tolerance_mm, std::vector<OpenPixel>& open) {
    constexpr std::size_t kMost = 1500;
    const std::size_t before = open.size();
    for (std::size_t pixel = 0; pixel < sheet.values.size(); ++pixel)
        if (sheet.depths[pixel] > tolerance_mm) {
            if (open.size() - before == kMost) return open.resize(before);
            open.push_back({&sheet, pixel, look.plane().from_uv(sheet.lattice.at(pixel))});
        }
}

}  // namespace

PlaneLook::PlaneLook(const Section& section, const ContourSet& set, const DrawingSize& size)
    : section_(&section), plane_(section.plane), raster_(rasterize(section)), search_(std::in_place, section) {
    constexpr double kFarStep = 1.0 / 16;  // of the ball's radius
    area_mm2_ = raster_.area_mm2;
    near_.lattice = raster_.lattice;
    near_.filled = raster_.filled;
    const double same_plane_mm = kSamePlane * size.ball.diameter();
    for (const Contour& contour : set.contours) {
        if (contour.closed || !lies_in(contour, plane_, same_plane_mm)) continue;
        for (std::size_t i = 1; i < contour.points.size(); ++i)
            open_edges_.emplace_back(plane_.to_uv(contour.points[i - 1]), plane_.to_uv(contour.points[i]));
    }
    lay_far_sheet(kFarStep * size.ball.radius, size);
}

PlaneLook::PlaneLook(const Plane& empty, double area_mm2, const DrawingSize& size) : plane_(empty), area_mm2_(area_mm2) {
    constexpr double kStep = 1.0 / 40;  // of the ball's radius
    lay_far_sheet(kStep * size.ball.radius, size);
}

std::optional<std::size_t> PlaneLook::contour() const {
    if (!section_) return std::nullopt;
    return section_->contours.front();
}

double PlaneLook::clearance(const Point2& p) const {
    return search_ ? search_->clearance(p) : std::numeric_limits<double>::infinity();
}

std::vector<Vec3> PlaneLook::filled_places(std::size_t most) const {
    std::size_t count = 0;
    for (const std::uint8_t filled : raster_.filled) count += filled;
    std::vector<Vec3> places;
    std::size_t seen = 0, next = 0;
    for (std::size_t pixel = 0; pixel < raster_.filled.size(); ++pixel) {
        if (!raster_.filled[pixel]) continue;
        // At the middles of `most` equal stretches of the count.
        if (seen++ == next) {
            places.push_back(plane_.from_uv(raster_.lattice.at(pixel)));
            next = std::max(next + 1, places.size() * count / std::max<std::size_t>(most, 1));
        }
    }
    return places;
}

void PlaneLook::lay_far_sheet(double step_mm, const DrawingSize& size) {
    constexpr double kReach = 1.25;  // radii from the ball's middle
    const double reach = kReach * size.ball.radius, off = plane_.distance_to(size.ball.center);
    if (!(step_mm > 0) || std::abs(off) >= reach) return;
    const double radius = std::sqrt(reach * reach - off * off);
    const Point2 middle = plane_.to_uv(size.ball.center);
    const int count = static_cast<int>(2 * radius / step_mm) + 1;
    const double half = step_mm * (count - 1) / 2;
    far_.lattice = {{middle[0] - half, middle[1] - half}, step_mm, count, count};
    far_.filled.assign(far_.lattice.count(), 0);
    far_.counted.assign(far_.lattice.count(), 0);
    for (std::size_t pixel = 0; pixel < far_.lattice.count(); ++pixel) {
        const Point2 p = far_.lattice.at(pixel);
        far_.counted[pixel] = std::hypot(p[0] - middle[0], p[1] - middle[1]) <= radius && !near_.lattice.pixel_at(p);
    }
}

double PlaneLook::depth_at(const Point2& p, double value) const {
    if (!search_) return value;
    const double depth = search_->clearance(p);
    for (const auto& [a, b] : open_edges_)
        if (distance_to_segment(p, a, b) <= depth) return 0;
    return depth;
}

void PlaneLook::measure_depths() {
    for (Sheet* sheet : {&near_, &far_}) {
        sheet->depths.assign(sheet->values.size(), 0);
        for (std::size_t pixel = 0; pixel < sheet->values.size(); ++pixel)
            if (sheet->differs(pixel)) sheet->depths[pixel] = depth_at(sheet->lattice.at(pixel), sheet->values[pixel]);
    }
}

void look(std::span<PlaneLook> looks, const PlaceValues& values, const PlaceValues& exact, const DrawingSize& size,
          const Work& work) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<OpenPixel> open;
    for (PlaneLook& look : looks) {
        Sheet &near = look.near(), &far = look.far();
        near.values.assign(near.lattice.count(), kUnknown);
        far.values.assign(far.lattice.count(), kUnknown);
        for (int row = 0; row < near.lattice.rows; ++row)
            for (int column = 0; column < near.lattice.columns; ++column)
                if (Blocks::is_corner(column, row, near.lattice)) {
                    const std::size_t pixel = near.lattice.index(column, row);
                    open.push_back({&near, pixel, look.plane().from_uv(near.lattice.at(pixel))});
                }
        for (std::size_t pixel = 0; pixel < far.lattice.count(); ++pixel)
            if (far.counts(pixel)) open.push_back({&far, pixel, look.plane().from_uv(far.lattice.at(pixel))});
    }
    answer(open, values);
    for (PlaneLook& look : looks) Blocks(look).ask_or_infer(open);
    answer(open, values);
    const auto measure = [&] {
        parallel_for(static_cast<std::int64_t>(looks.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t n = begin; n < end; ++n) looks[static_cast<std::size_t>(n)].measure_depths();
        });
    };
    measure();
    if (!exact) return;
    for (PlaneLook& look : looks)
        for (Sheet* sheet : {&look.near(), &look.far()}) ask_again(look, *sheet, size.tolerance_mm, open);
    if (open.empty()) return;
    answer(open, exact);
    measure();
}

}  // namespace kontur
