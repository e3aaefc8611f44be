// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/polygonize.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "kontur/base/error.h"
#include "kontur/extract/cell_triangles.h"
#include "kontur/extract/sign_change.h"
#include "kontur/extract/tracker.h"

namespace kontur {
namespace {

constexpr std::size_t kEvaluationsPerCell = 3;  // a cell has about one cut edge: a normal, two values to find its place
constexpr double kTolerance = 0.02;             // of the fast function's values, in the grid's smallest spacing
constexpr double kSmallValue = 5e-3;            // in the smallest spacing: a point with less is on the surface
constexpr int kMostSteps = 8;
constexpr double kSureStep = 0.1;  // of an edge: after one that is longer the point is looked at again
// What the lattice shows of an edge is believed where its values bend by no more than a share of their slope, along all axes
// at both ends, and the cubic through four of them leaves the chord by no more than a share of the edge. Half the first
// share leaves twice as many sums; twice as much misses by up to half again as much.
constexpr double kStraight = 0.2, kSureCubic = 0.025;

/// A lattice edge on which f changes its sign.
struct CutEdge {
    std::uint32_t point;  ///< of the mesh
    int axis;
    Index3 from;
    SignChange<double> zero{.low = 0, .high = 1};  ///< where f vanishes, as fractions of the edge

    double fraction() const { return zero.low + zero.zero() * (zero.high - zero.low); }
};

/// Off the ends of the edge, so that no triangle collapses.
double kept_off_ends(double fraction) { return std::clamp(fraction, 1e-4, 1 - 1e-4); }

class MeshBuilder {
public:
    explicit MeshBuilder(const SurfaceLattice& surface)
        : lattice_(surface.lattice),
          mm_to_index_(lattice_.grid().index_to_mm.inverse()),
          mirrored_(lattice_.grid().index_to_mm.determinant() < 0) {
        points_.reserve(2 * surface.cells.size());
    }

    void add_cell(const Index3& cell) {
        const std::array<double, 8> corners = lattice_.corners(cell);
        for (const CellTriangle& t : cell_triangles(inside_corners(corners))) {
            std::array<std::uint32_t, 3> triangle{point_on(cell, t[0], corners), point_on(cell, t[1], corners),
                                                  point_on(cell, t[2], corners)};
            if (mirrored_) std::swap(triangle[1], triangle[2]);
            mesh_.triangles.push_back(triangle);
        }
    }

    /// Points and normals of the edges about which the lattice knows enough: a cubic along the edge, differences at its
    /// ends. Other edges are left to `settle_at_once`: between slices that are far apart, or in thin sheets, the values
    /// bend.
    void settle_by_lattice() {
        mesh_.normals.resize(mesh_.points.size());
        std::erase_if(edges_, [&](const CutEdge& edge) {
            const std::optional<double> fraction = zero_of_cubic(edge);
            Index3 to = edge.from;
            to[edge.axis] += 1;
            const std::optional<Vec3> low = differences(edge.from), high = differences(to);
            if (!fraction || !low || !high) return false;
            mesh_.points[edge.point] = place(edge.from, edge.axis, *fraction);
            mesh_.normals[edge.point] = gradient_mm(*low + *fraction * (*high - *low));
            return true;
        });
    }

    /// Normals of the points that linear interpolation placed, from what values are known around them.
    void settle_roughly() {
        for (const CutEdge& edge : edges_) {
            Index3 to = edge.from;
            to[edge.axis] += 1;
            const Vec3 low = rough_differences(edge.from), high = rough_differences(to);
            mesh_.normals[edge.point] = gradient_mm(low + edge.fraction() * (high - low));
        }
        edges_.clear();
    }

    /// Moves the points by one step of Newton's method along their edges, with values and normals from where linear
    /// interpolation put them: a step of a tenth of an edge leaves some thousandths of it. Those with longer steps are left
    /// to `settle_vertices`, and get their normals afterwards.
    void settle_at_once(FastFunction& function, const Work& work) {
        std::vector<Vec3> places, gradients(edges_.size());
        std::vector<double> values(edges_.size());
        for (const CutEdge& edge : edges_) places.push_back(mesh_.points[edge.point]);
        if (function.is_direct()) {
            function.exact().values_and_gradients(places, values, gradients, work);
        } else {
            function.values(places, values, work);
            function.gradients(places, gradients, work);
        }
        std::vector<CutEdge> far;
        for (std::size_t n = 0; n < edges_.size(); ++n) {
            const CutEdge& edge = edges_[n];
            mesh_.normals[edge.point] = gradients[n];
            const double along = dot(gradients[n], lattice_.grid().index_to_mm.column(edge.axis));
            const double step = -values[n] / along, at = kept_off_ends(edge.fraction()) + step;
            if (std::abs(step) <= kSureStep && at == kept_off_ends(at))
                mesh_.points[edge.point] = place(edge.from, edge.axis, at);
            else far.push_back(edge);
        }
        edges_ = far;
        settle_vertices(function, work);
        places.clear();
        for (const CutEdge& edge : far) places.push_back(mesh_.points[edge.point]);
        gradients.resize(places.size());
        function.gradients(places, gradients, work);
        for (std::size_t n = 0; n < far.size(); ++n) mesh_.normals[far[n].point] = gradients[n];
    }

    /// Moves the points from where linear interpolation put them to the function's zeros; all of them step by step, because
    /// the function is cheaper in bulk. Between slices that are far apart the difference is a large part of a voxel.
    void settle_vertices(FastFunction& function, const Work& work) {
        const double small_mm = kSmallValue * smallest(lattice_.grid().spacing_mm());
        std::vector<Vec3> places;
        std::vector<double> values;
        for (int step = 0; step < kMostSteps && !edges_.empty(); ++step) {
            places.clear();
            for (const CutEdge& edge : edges_) places.push_back(mesh_.points[edge.point]);
            values.resize(places.size());
            function.values(places, values, work);
            std::size_t kept = 0;
            for (std::size_t n = 0; n < edges_.size(); ++n) {
                if (!(std::abs(values[n]) > small_mm)) continue;
                CutEdge edge = edges_[n];
                edge.zero.narrow(kept_off_ends(edge.fraction()), values[n]);
                mesh_.points[edge.point] = place(edge.from, edge.axis, kept_off_ends(edge.fraction()));
                edges_[kept++] = edge;
            }
            edges_.resize(kept);
        }
    }

    void find_gradients(FastFunction& function, const Work& work) {
        mesh_.normals.resize(mesh_.points.size());
        function.gradients(mesh_.points, mesh_.normals, work);
    }

    /// Normals are those of the function, which knows nothing of the cut at the grid's border: there, the border's.
    TriangleMesh finish() {
        for (Vec3& n : mesh_.normals) n = -normalized(n);
        for (const auto& [point, normal] : border_normals_) mesh_.normals[point] = normal;
        return std::move(mesh_);
    }

private:
    std::uint32_t point_on(const Index3& cell, int edge_number, const std::array<double, 8>& corners) {
        const CellEdge& edge = cell_edges()[static_cast<std::size_t>(edge_number)];
        const Index3 from = Lattice::corner(cell, edge.from);
        const Index3& size = lattice_.grid().size;
        const auto linear =
            static_cast<std::uint64_t>((from.i + 1) + (size.i + 2) * ((from.j + 1) + (size.j + 2) * (from.k + 1)));
        const auto [found, is_new] = points_.try_emplace(3 * linear + static_cast<std::uint64_t>(edge.axis),
                                                         static_cast<std::uint32_t>(mesh_.points.size()));
        if (is_new) {
            if (mesh_.points.size() >= std::numeric_limits<std::uint32_t>::max())
                throw Error(ErrorKind::too_large, "the surface has more than 4294967295 points; use a larger spacing");
            CutEdge cut{found->second, edge.axis, from};
            cut.zero.low_value = corners[static_cast<std::size_t>(edge.from)];
            cut.zero.high_value = corners[static_cast<std::size_t>(edge.to)];
            const bool leaves_grid = !std::isfinite(cut.zero.low_value) || !std::isfinite(cut.zero.high_value);
            mesh_.points.push_back(place(from, edge.axis, leaves_grid ? 0.5 : kept_off_ends(cut.fraction())));
            if (!leaves_grid) edges_.push_back(cut);
            if (!lattice_.in_grid(from)) border_normals_.emplace_back(found->second, -border_normal(edge.axis));
            if (!lattice_.in_grid(Lattice::corner(cell, edge.to)))
                border_normals_.emplace_back(found->second, border_normal(edge.axis));
        }
        return found->second;
    }

    /// Where Lagrange's cubic through the values at an edge's ends and at their neighbours along it vanishes; none where a
    /// value is unknown, or where it does so far from the chord.
    std::optional<double> zero_of_cubic(const CutEdge& edge) const {
        Index3 before = edge.from, behind = edge.from;
        before[edge.axis] -= 1;
        behind[edge.axis] += 2;
        const double v0 = lattice_.value(before), v1 = edge.zero.low_value, v2 = edge.zero.high_value,
                     v3 = lattice_.value(behind);
        if (!std::isfinite(v0) || !std::isfinite(v3)) return std::nullopt;
        const double chord = kept_off_ends(edge.fraction());
        double t = chord;
        for (int step = 0; step < 2; ++step) {
            const double a = t + 1, b = t, c = t - 1, d = t - 2;
            const double value = -v0 * b * c * d / 6 + v1 * a * c * d / 2 - v2 * a * b * d / 2 + v3 * a * b * c / 6;
            t = kept_off_ends(t + value / (v1 - v2));
        }
        return std::abs(t - chord) <= kSureCubic ? std::optional(t) : std::nullopt;
    }

    /// The slope per index at a lattice point by differences; none where a neighbour's value is unknown or values bend.
    std::optional<Vec3> differences(const Index3& at) const {
        const double here = lattice_.value(at);
        Vec3 slope, bend;
        for (int axis = 0; axis < 3; ++axis) {
            Index3 low = at, high = at;
            low[axis] -= 1;
            high[axis] += 1;
            const double before = lattice_.value(low), behind = lattice_.value(high);
            slope[axis] = 0.5 * (behind - before);
            bend[axis] = before - 2 * here + behind;
        }
        const double most = kStraight * norm(slope);
        return std::isfinite(most) && norm(bend) <= most ? std::optional(slope) : std::nullopt;
    }

    /// The slope per index at a lattice point, on one side of it where nothing else is known; 0 along an axis without.
    Vec3 rough_differences(const Index3& at) const {
        const double here = lattice_.value(at);
        Vec3 slope;
        for (int axis = 0; axis < 3; ++axis) {
            Index3 low = at, high = at;
            low[axis] -= 1;
            high[axis] += 1;
            double before = lattice_.value(low), behind = lattice_.value(high);
            const bool is_between = std::isfinite(before) && std::isfinite(behind);
            if (!std::isfinite(before)) before = here;
            if (!std::isfinite(behind)) behind = here;
            slope[axis] = (is_between ? 0.5 : 1.0) * (behind - before);
        }
        return slope;
    }

    /// A gradient per mm from one per index.
    Vec3 gradient_mm(const Vec3& by_index) const {
        Vec3 gradient;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::array<double, 3>& row = mm_to_index_.linear[axis];
            gradient += by_index[static_cast<int>(axis)] * Vec3{row[0], row[1], row[2]};
        }
        return gradient;
    }

    Vec3 place(const Index3& from, int axis, double fraction) const {
        Vec3 at{static_cast<double>(from.i), static_cast<double>(from.j), static_cast<double>(from.k)};
        at[axis] += fraction;
        return lattice_.grid().index_to_mm.apply(at);
    }

    /// Normal of the grid's face at its high end along an axis.
    Vec3 border_normal(int axis) const {
        const std::array<double, 3>& row = mm_to_index_.linear[static_cast<std::size_t>(axis)];
        return normalized({row[0], row[1], row[2]});
    }

    const Lattice& lattice_;
    Affine3 mm_to_index_;
    bool mirrored_;
    std::unordered_map<std::uint64_t, std::uint32_t> points_;  ///< lattice edge -> point
    TriangleMesh mesh_;
    std::vector<CutEdge> edges_;  ///< whose points may not be on the surface yet
    std::vector<std::pair<std::uint32_t, Vec3>> border_normals_;
};

}  // namespace

TriangleMesh polygonize(const SurfaceLattice& surface, FastFunction& function, const Work& work, MeshAccuracy accuracy) {
    MeshBuilder builder(surface);
    for (const Index3& cell : surface.cells) builder.add_cell(cell);
    work.report("polygonize", 0.3);
    if (accuracy == MeshAccuracy::of_a_screen) {
        builder.settle_by_lattice();
        builder.settle_at_once(function, work);
        return builder.finish();
    }
    builder.settle_vertices(function, work);
    work.report("polygonize", 0.6);
    builder.find_gradients(function, work);
    return builder.finish();
}

TriangleMesh polygonize(const SurfaceLattice& surface) {
    MeshBuilder builder(surface);
    for (const Index3& cell : surface.cells) builder.add_cell(cell);
    builder.settle_by_lattice();
    builder.settle_roughly();
    return builder.finish();
}

TriangleMesh polygonize(const SurfaceLattice& surface, const ImplicitFunction& function, const Work& work) {
    FastFunction fast(function, {.tolerance_mm = kTolerance * smallest(surface.lattice.grid().spacing_mm()),
                                 .expected_points = static_cast<std::int64_t>(kEvaluationsPerCell * surface.cells.size())});
    return polygonize(surface, fast, work);
}

}  // namespace kontur
