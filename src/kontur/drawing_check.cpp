// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kontur/base/parallel.h"
#include "kontur/function/fast_function.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// What a voxel grid says of f at a place.
class VoxelValues {
public:
    VoxelValues(const SurfaceLattice& surface, const Mask& mask, bool is_cut_off)
        : lattice_(surface.lattice), mask_(mask), to_index_(mask.grid.index_to_mm.inverse()), is_cut_off_(is_cut_off) {
        const Vec3 spacing = mask.grid.spacing_mm();
        half_mm_ = std::min({spacing.x, spacing.y, spacing.z}) / 2;
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

/// Of the section that is thinnest beside its lines.
double least_width_mm(const ContourSet& contours) {
    double least = std::numeric_limits<double>::infinity();
    for (const Contour& contour : contours.contours) {
        if (!contour.closed) continue;
        const double length = line_length(contour.points, true);
        Polygon2 outline;
        for (const Vec3& p : contour.points) outline.push_back(contour.plane.to_uv(p));
        if (length > 0) least = std::min(least, 2 * area(outline) / length);
    }
    return least;
}

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

}  // namespace

SectionCheck check_sections(const Drawing& drawing, const PlaceValues& values, const PlaceValues& exact, const Work& work) {
    return numbered_as_drawn(check_sections(drawing.contours, values, exact, work), drawing);
}

SectionCheck check_sections(const Drawing& drawing, const ImplicitFunction& function, const Work& work) {
    constexpr double kTolerance = 5e-4;  // of the diameter: a ninth of what counts
    FastFunction fast(function, {.tolerance_mm = std::max(kTolerance * drawing.diameter_mm(), 1e-9),
                                 .expected_points = 3000 * static_cast<std::int64_t>(drawing.contours.contours.size())});
    const PlaceValues values = [&](std::span<const Vec3> places, std::span<double> out) { fast.values(places, out, work); };
    return check_sections(drawing, values, {}, work);
}

SectionCheck check_sections(const Drawing& drawing, const ImplicitFunction& function, const SurfaceLattice& surface,
                            const Mask& mask, const Work& work) {
    constexpr double kWidest = 0.5;  // a voxel, of the thinnest section
    const Vec3 spacing = mask.grid.spacing_mm();
    if (std::max({spacing.x, spacing.y, spacing.z}) > kWidest * least_width_mm(drawing.contours))
        return check_sections(drawing, function, work);
    const VoxelValues voxels(surface, mask, reaches_border(surface));
    const PlaceValues exact = values_of(function, work);
    const PlaceValues values = [&](std::span<const Vec3> places, std::span<double> out) {
        constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
        parallel_for(static_cast<std::int64_t>(places.size()), 4096, work, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t n = begin; n < end; ++n) {
                const auto p = static_cast<std::size_t>(n);
                out[p] = voxels.at(places[p]).value_or(kUnknown);
            }
        });
        std::vector<Vec3> left;
        for (std::size_t p = 0; p < places.size(); ++p)
            if (std::isnan(out[p])) left.push_back(places[p]);
        std::vector<double> found(left.size());
        if (!left.empty()) exact(left, found);
        std::size_t next = 0;
        for (double& value : out)
            if (std::isnan(value)) value = found[next++];
    };
    return check_sections(drawing, values, exact, work);
}

}  // namespace kontur
