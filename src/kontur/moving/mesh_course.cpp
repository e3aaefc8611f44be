// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/mesh_course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "kontur/base/error.h"
#include "kontur/extract/adaptive.h"
#include "kontur/extract/polygonize.h"
#include "kontur/extract/preview.h"
#include "kontur/extract/voxelize.h"
#include "kontur/function/fast_function.h"

namespace kontur {
namespace {

constexpr double kTolerance = 0.02;  // of values, in spacings
constexpr float kLeast = std::numeric_limits<float>::min();

/// The lattice about all starts, with its spacing.
Grid lattice_about(std::span<const Vec3> starts, double spacing_mm, std::size_t moments) {
    std::optional<Grid> grid = preview_lattice(starts, spacing_mm);
    if (!grid) throw Error(ErrorKind::invalid_input, "there is no finite point of a surface; at least 1 is needed");
    const double points = static_cast<double>(grid->voxel_count()) * static_cast<double>(moments);
    if (points <= MeshCourse::kMostPoints) return *grid;
    return *preview_lattice(starts, spacing_mm * std::cbrt(1.05 * points / MeshCourse::kMostPoints));
}

/// Places of a lattice, and those beside them.
class PointSet {
public:
    explicit PointSet(const Grid& grid) : grid_(grid), is_in_(static_cast<std::size_t>(grid.voxel_count())) {}

    void add_around(const Index3& p) {
        for (std::int64_t k = std::max<std::int64_t>(p.k - 1, 0); k <= std::min(p.k + 1, grid_.size.k - 1); ++k)
            for (std::int64_t j = std::max<std::int64_t>(p.j - 1, 0); j <= std::min(p.j + 1, grid_.size.j - 1); ++j)
                for (std::int64_t i = std::max<std::int64_t>(p.i - 1, 0); i <= std::min(p.i + 1, grid_.size.i - 1); ++i)
                    is_in_[grid_.offset(i, j, k)] = true;
    }
    bool contains(std::size_t offset) const { return is_in_[offset]; }
    bool contains_corners(const Index3& cell) const {
        for (int n = 0; n < 8; ++n) {
            const Index3 corner = Lattice::corner(cell, n);
            if (corner.i >= grid_.size.i || corner.j >= grid_.size.j || corner.k >= grid_.size.k) return false;
            if (!is_in_[grid_.offset(corner.i, corner.j, corner.k)]) return false;
        }
        return true;
    }

private:
    const Grid& grid_;
    std::vector<bool> is_in_;
};

}  // namespace

MeshCourse::MeshCourse(const MovingFunction& function, const std::vector<std::vector<Vec3>>& starts, double spacing_mm,
                       const Work& work)
    : course_(function.course()) {
    const std::size_t moments = function.functions().size();
    if (starts.size() != moments)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("there are starts of {} moments, and {} moments; each needs some", starts.size(), moments));
    std::vector<Vec3> all;
    for (const std::vector<Vec3>& some : starts) all.insert(all.end(), some.begin(), some.end());
    grid_ = lattice_about(all, spacing_mm, moments);
    std::vector<SurfaceLattice> surfaces;
    for (std::size_t k = 0; k < moments; ++k) {
        work.report("surfaces of moments", static_cast<double>(k) / static_cast<double>(moments));
        surfaces.push_back(track_surface_adaptively(function.functions()[k], grid_, starts[k], work.untold()));
    }
    mark_moments(surfaces);
    choose_points(surfaces);
    evaluate(function, work);
}

void MeshCourse::mark_moments(const std::vector<SurfaceLattice>& surfaces) {
    for (const SurfaceLattice& surface : surfaces) {
        const Mask mask = fill(surface);
        inside_.emplace_back(mask.values.begin(), mask.values.end());
    }
}

void MeshCourse::choose_points(const std::vector<SurfaceLattice>& surfaces) {
    PointSet chosen(grid_);
    for (const SurfaceLattice& surface : surfaces)
        for (const Index3& cell : surface.cells) {
            chosen.add_around(cell);
            chosen.add_around(Lattice::corner(cell, 7));
        }
    const std::vector<bool>& first = inside_.front();
    for (std::size_t v = 0; v < first.size(); ++v)
        if (std::any_of(inside_.begin(), inside_.end(), [&](const auto& other) { return other[v] != first[v]; }))
            chosen.add_around(index_at(v, grid_.size));
    for (std::size_t v = 0; v < first.size(); ++v) {
        if (!chosen.contains(v)) continue;
        const Index3 at = index_at(v, grid_.size);
        points_.push_back(at);
        if (chosen.contains_corners(at)) cells_.push_back(at);
    }
}

void MeshCourse::evaluate(const MovingFunction& function, const Work& work) {
    const std::size_t moments = inside_.size();
    values_.resize(points_.size() * moments);
    std::vector<Vec3> places;
    for (const Index3& p : points_) places.push_back(grid_.center_mm(p.i, p.j, p.k));
    std::vector<double> values(places.size());
    for (std::size_t k = 0; k < moments; ++k) {
        work.report("values between moments", static_cast<double>(k) / static_cast<double>(moments));
        // Not those that finding the surface left: away from it their sign alone is right.
        FastFunction fast(function.functions()[k], {.tolerance_mm = kTolerance * spacing_mm(),
                                                    .expected_points = static_cast<std::int64_t>(places.size())});
        fast.values(places, values, work.untold());
        for (std::size_t n = 0; n < points_.size(); ++n) {
            // A sheet that no start touches is not there, whatever f says.
            const bool is_inside = inside_[k][grid_.offset(points_[n].i, points_[n].j, points_[n].k)];
            float& value = values_[n * moments + k] = static_cast<float>(values[n]);
            if (is_inside != (value > 0)) value = is_inside ? kLeast : 0.0F;
        }
    }
    inside_.clear();
}

TriangleMesh MeshCourse::at(double time) const {
    const TimeCourse::Place place = course_.place_of(time);
    const std::size_t moments = points_.empty() ? 1 : values_.size() / points_.size();
    SurfaceLattice surface{Lattice(grid_), {}};
    std::vector<double> values(moments);
    for (std::size_t n = 0; n < points_.size(); ++n) {
        std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(n * moments), moments, values.begin());
        surface.lattice.set_value(points_[n], course_.value(place, values));
    }
    for (const Index3& cell : cells_) {
        const unsigned inside = inside_corners(surface.lattice.corners(cell));
        if (inside != 0 && inside != 0xFF) surface.cells.push_back(cell);
    }
    return polygonize(surface);
}

std::optional<std::size_t> MeshCourse::number_of(const Index3& point) const {
    const auto offset = [&](const Index3& p) { return grid_.offset(p.i, p.j, p.k); };
    const auto found = std::ranges::lower_bound(points_, offset(point), {}, offset);
    if (found == points_.end() || *found != point) return std::nullopt;
    return static_cast<std::size_t>(found - points_.begin());
}

std::vector<double> MeshCourse::changes(const std::vector<Vec3>& points_mm, double time) const {
    std::vector<double> changes(points_mm.size(), 0.0);
    const TimeCourse::Place place = course_.place_of(time);
    if (place.before == place.after) return changes;
    const std::size_t moments = course_.times().size();
    const Affine3 to_index = grid_.index_to_mm.inverse();
    for (std::size_t n = 0; n < points_mm.size(); ++n) {
        const Vec3 at = to_index.apply(points_mm[n]);
        const auto below = [](double index) { return static_cast<std::int64_t>(std::floor(index)); };
        const Index3 cell{below(at.x), below(at.y), below(at.z)};
        double sum = 0, weights = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const Index3 p = Lattice::corner(cell, corner);
            const double weight = (1 - std::abs(at.x - static_cast<double>(p.i))) *
                                  (1 - std::abs(at.y - static_cast<double>(p.j))) *
                                  (1 - std::abs(at.z - static_cast<double>(p.k)));
            // Points of a surface lie on edges, whose ends are known; by rounding other corners get a weight of next to 0.
            const std::optional<std::size_t> number = weight > 1e-9 ? number_of(p) : std::nullopt;
            if (!number) continue;
            const float* values = &values_[*number * moments];
            sum += weight * (values[place.after] - values[place.before]);
            weights += weight;
        }
        if (weights > 0) changes[n] = std::abs(sum / weights);
    }
    return changes;
}

}  // namespace kontur
