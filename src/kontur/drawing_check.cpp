// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kontur/base/parallel.h"
#include "kontur/drawing/image_box.h"
#include "kontur/function/fast_function.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// What a voxel grid says of f at a place.
class VoxelValues {
public:
    VoxelValues(const SurfaceLattice& surface, const Mask& mask, bool is_cut_off)
        : lattice_(surface.lattice), mask_(mask), to_index_(mask.grid.index_to_mm.inverse()), is_cut_off_(is_cut_off) {
        half_mm_ = smallest(mask.grid.spacing_mm()) / 2;
    }

    /// Between voxels of one side their side, at half a voxel's depth; where the surface passes, interpolated; nothing where
    /// values are not known.
    std::optional<double> at(const Vec3& place) const {
        const Vec3 index = to_index_.apply(place);
        Index3 low;
        Vec3 part;
        for (int axis = 0; axis < 3; ++axis) {
            const double last = static_cast<double>(mask_.grid.size[axis] - 1);
            if (!(index[axis] > -0.5 && index[axis] < last + 0.5)) return beyond();
            const double inner = std::clamp(index[axis], 0.0, last);
            double floor = std::floor(inner);
            if (inner - floor > 1 - kOnVoxel) floor += 1;
            low[axis] = static_cast<std::int64_t>(floor);
            part[axis] = inner - floor < kOnVoxel ? 0 : inner - floor;
        }
        return between(low, part);
    }

private:
    static constexpr double kOnVoxel = 1e-6;

    /// Where the grid ends, and the object does not, only f knows.
    std::optional<double> beyond() const {
        if (is_cut_off_) return std::nullopt;
        return -half_mm_;
    }

    std::optional<double> between(const Index3& low, const Vec3& part) const {
        double sum = 0;
        int inside = 0, corners = 0;
        bool known = true;
        for (int n = 0; n < 8; ++n) {
            const Index3 corner = Lattice::corner(low, n);
            double weight = 1;
            for (int axis = 0; axis < 3; ++axis) weight *= (n >> axis & 1) != 0 ? part[axis] : 1 - part[axis];
            if (!(weight > 0)) continue;
            ++corners;
            inside += mask_.values[mask_.grid.offset(corner.i, corner.j, corner.k)] != 0;
            const double value = lattice_.value(corner);
            known = known && std::isfinite(value);
            sum += weight * value;
        }
        if (inside == 0) return -half_mm_;
        if (inside == corners) return half_mm_;
        if (!known) return std::nullopt;
        return sum;
    }

    const Lattice& lattice_;
    const Mask& mask_;
    Affine3 to_index_;
    double half_mm_;
    bool is_cut_off_;
};

bool reaches_border(const SurfaceLattice& surface) {
    const Index3& size = surface.lattice.grid().size;
    return std::any_of(surface.cells.begin(), surface.cells.end(), [&](const Index3& c) {
        return c.i < 0 || c.j < 0 || c.k < 0 || c.i + 1 >= size.i || c.j + 1 >= size.j || c.k + 1 >= size.k;
    });
}

/// Where something is drawn that is about as thin as a voxel is wide: voxels may lie on both sides of it.
class ThinPlaces {
public:
    ThinPlaces(const Drawing& drawing, double voxel_mm) : voxel_mm_(voxel_mm) {
        for (const Section& section : sections_of(drawing.contours, kSamePlane * drawing.diameter_mm())) {
            double enclosed = 0, length = 0;
            Box3 all;
            for (std::size_t o = 0; o < section.outlines.size(); ++o) {
                const double own = area(section.outlines[o]), around = perimeter(section.outlines[o]);
                const Box3 box = bounding_box(drawing.contours.contours[section.contours[o]].points);
                all.extend(box.min), all.extend(box.max);
                add_if_thin(own, around, box);
                enclosed += section.layer(o) * own;
                length += around;
            }
            if (section.outlines.size() > 1) add_if_thin(enclosed, length, all);
        }
    }

    std::size_t count() const { return boxes_.size(); }
    bool contain(const Vec3& place) const {
        return std::any_of(boxes_.begin(), boxes_.end(), [&](const Box3& box) { return box.contains(place); });
    }

private:
    /// Of half the length of its lines the area makes a mean width.
    void add_if_thin(double area_mm2, double length_mm, const Box3& box) {
        constexpr double kWidest = 0.5;  // a voxel, of the mean width
        if (voxel_mm_ * length_mm <= kWidest * 2 * area_mm2) return;
        boxes_.push_back(box.padded(voxel_mm_));
    }

    double voxel_mm_;
    std::vector<Box3> boxes_;
};

SectionCheck numbered_as_drawn(SectionCheck check, const Drawing& drawing) {
    const auto rename = [&](std::size_t& contour) { contour = drawing.numbers[contour]; };
    for (PlaneCheck& plane : check.planes)
        if (plane.contour) rename(*plane.contour);
    for (BetweenCheck& between : check.between) rename(between.contour), rename(between.other);
    for (BeyondCheck& beyond : check.beyond) rename(beyond.contour);
    return check;
}

PlaceValues values_of(const ImplicitFunction& function, const Work& work) {
    return
        [&function, work](std::span<const Vec3> places, std::span<double> values) { function.values(places, values, work); };
}

/// For the places of so many contours.
FastFunction fast_function(const Drawing& drawing, const ImplicitFunction& function, std::size_t contours) {
    constexpr double kTolerance = 5e-4;  // of the diameter: a ninth of what counts
    return FastFunction(function, {.tolerance_mm = std::max(kTolerance * drawing.diameter_mm(), 1e-9),
                                   .expected_points = 3000 * static_cast<std::int64_t>(contours)});
}

}  // namespace

SectionCheck check_sections(const Drawing& drawing, const PlaceValues& values, const PlaceValues& exact, const Work& work) {
    return numbered_as_drawn(check_sections(drawing.contours, values, exact, work), drawing);
}

SectionCheck check_sections(const Drawing& drawing, const ImplicitFunction& function, const Work& work) {
    FastFunction fast = fast_function(drawing, function, drawing.contours.contours.size());
    const PlaceValues values = [&](std::span<const Vec3> places, std::span<double> out) { fast.values(places, out, work); };
    return check_sections(drawing, values, {}, work);
}

SectionCheck check_sections(const Drawing& drawing, const ImplicitFunction& function, const SurfaceLattice& surface,
                            const Mask& mask, const Work& work) {
    const ThinPlaces thin(drawing, largest(mask.grid.spacing_mm()));
    const bool is_on_image = image_of(drawing.contours, mask.grid).has_value();
    const VoxelValues voxels(surface, mask, reaches_border(surface) && !is_on_image);
    FastFunction fast = fast_function(drawing, function, thin.count());
    const PlaceValues values = [&](std::span<const Vec3> places, std::span<double> out) {
        constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
        parallel_for(static_cast<std::int64_t>(places.size()), 4096, work, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t n = begin; n < end; ++n) {
                const auto p = static_cast<std::size_t>(n);
                out[p] = thin.contain(places[p]) ? kUnknown : voxels.at(places[p]).value_or(kUnknown);
            }
        });
        std::vector<Vec3> rest;
        for (std::size_t p = 0; p < places.size(); ++p)
            if (std::isnan(out[p])) rest.push_back(places[p]);
        std::vector<double> found(rest.size());
        if (!rest.empty()) fast.values(rest, found, work);
        std::size_t next = 0;
        for (double& value : out)
            if (std::isnan(value)) value = found[next++];
    };
    return check_sections(drawing, values, values_of(function, work), work);
}

}  // namespace kontur
