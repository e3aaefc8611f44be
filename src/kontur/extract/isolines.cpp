// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/isolines.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"

namespace kontur {
namespace {

constexpr std::int64_t kMaxNodes = std::int64_t{1} << 28;

struct Node {
    std::int64_t i, j;
};

/// A side of a lattice cell: side s joins corner s to corner s + 1, counter-clockwise from the lower left corner.
struct CellSide {
    std::int64_t i, j;  ///< the cell's lower left node
    int side;

    static Node corner(std::int64_t i, std::int64_t j, int c) { return {i + (c == 1 || c == 2), j + (c >= 2)}; }
    Node from() const { return corner(i, j, side); }
    Node to() const { return corner(i, j, (side + 1) % 4); }
    /// The same edge seen from the cell on its other side.
    CellSide across() const {
        static constexpr std::int64_t di[4] = {0, 1, 0, -1}, dj[4] = {-1, 0, 1, 0};
        return {i + di[side], j + dj[side], (side + 2) % 4};
    }
};

class MarchingSquares {
public:
    MarchingSquares(const IsolineLattice& lattice, std::span<const double> values,
                    const std::function<double(double, double)>& exact)
        : lattice_(lattice), values_(values), exact_(exact), visited_(values.size()) {}

    std::vector<Isoline> lines() {
        std::vector<Isoline> lines;
        // Every closed line crosses some row upwards, the inside on its left: these edges alone find all lines.
        for (std::int64_t j = 0; j < lattice_.rows; ++j)
            for (std::int64_t i = 0; i < lattice_.columns; ++i)
                if (inside({i, j}) && !inside({i + 1, j}) && !visited_[offset({i, j})]) lines.push_back(follow({i, j, 0}));
        return lines;
    }

private:
    /// Walks once around the line that enters a cell through `start`.
    Isoline follow(const CellSide& start) {
        Isoline line;
        CellSide entry = start;
        do {
            if (entry.side == 0) visited_[offset(entry.from())] = true;
            line.points.push_back(crossing(entry.from(), entry.to()));
            entry = exit(entry).across();
        } while (entry.i != start.i || entry.j != start.j || entry.side != start.side);
        return line;
    }

    /// Lines enter a cell where its boundary, run through counter-clockwise, leaves the inside, and exit where it returns.
    CellSide exit(const CellSide& entry) const {
        const auto side = [&](int turn) { return CellSide{entry.i, entry.j, (entry.side + turn) % 4}; };
        const auto returns = [&](const CellSide& s) { return !inside(s.from()) && inside(s.to()); };
        const bool ambiguous = returns(side(1)) && returns(side(3));
        if (ambiguous) return side(joined(entry) ? 1 : 3);
        return returns(side(1)) ? side(1) : returns(side(2)) ? side(2) : side(3);
    }

    /// Whether the two inside corners of an ambiguous cell, one of them `entry.from()`, belong together: sign of the saddle.
    bool joined(const CellSide& entry) const {
        const auto corner = [&](int turn) { return value(CellSide::corner(entry.i, entry.j, (entry.side + turn) % 4)); };
        return corner(0) * corner(2) > corner(1) * corner(3);
    }

    std::array<double, 2> crossing(const Node& in, const Node& out) const {
        const double v_in = value(in), v_out = value(out);
        double t = std::isfinite(v_out) ? v_in / (v_in - v_out) : 0.5;
        const auto a = lattice_.uv(in.i, in.j), b = lattice_.uv(out.i, out.j);
        const auto at = [&](double s) { return std::array{a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])}; };
        if (exact_ && std::isfinite(v_out)) t = bisect(at);
        return at(t);
    }

    template <class At>
    double bisect(const At& at) const {
        double low = 0, high = 1;
        for (int step = 0; step < 48; ++step) {
            const double middle = 0.5 * (low + high);
            const auto uv = at(middle);
            (exact_(uv[0], uv[1]) > 0 ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

    bool in_lattice(const Node& n) const { return n.i >= 0 && n.j >= 0 && n.i < lattice_.columns && n.j < lattice_.rows; }
    std::size_t offset(const Node& n) const { return static_cast<std::size_t>(n.i + n.j * lattice_.columns); }
    double value(const Node& n) const {
        return in_lattice(n) ? values_[offset(n)] : -std::numeric_limits<double>::infinity();
    }
    bool inside(const Node& n) const { return value(n) > 0; }

    const IsolineLattice& lattice_;
    std::span<const double> values_;
    const std::function<double(double, double)>& exact_;
    std::vector<bool> visited_;
};

double signed_area(std::span<const std::array<double, 2>> points) {
    double twice = 0;
    const auto& o = points.front();  // relative to a point of the line: no cancellation far from the plane's origin
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto &p = points[i], &q = points[(i + 1) % points.size()];
        twice += (p[0] - o[0]) * (q[1] - o[1]) - (q[0] - o[0]) * (p[1] - o[1]);
    }
    return 0.5 * twice;
}

}  // namespace

BoxCorners corners(const Box3& box) {
    BoxCorners result;
    for (unsigned c = 0; c < 8; ++c)
        result[c] = {c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y, c & 4 ? box.max.z : box.min.z};
    return result;
}

std::optional<IsolineLattice> lattice_over(const Plane& plane, const BoxCorners& region, double step_mm) {
    if (!(step_mm > 0) || !std::isfinite(step_mm))
        throw Error(ErrorKind::invalid_input, fmt::format("the sampling step is {:g} mm; it must be > 0", step_mm));
    Box3 section;  // in (u, v, distance)
    for (unsigned a = 0; a < 8; ++a)
        for (unsigned bit = 1; bit < 8; bit *= 2) {
            if (a & bit) continue;
            const Vec3 &p = region[a], &q = region[a | bit];
            const double dp = plane.distance_to(p), dq = plane.distance_to(q);
            if ((dp > 0) == (dq > 0) && dp != 0) continue;
            const auto uv = plane.to_uv(dp == dq ? p : p + (dp / (dp - dq)) * (q - p));
            section.extend({uv[0], uv[1], 0});
        }
    if (section.is_empty()) return std::nullopt;

    IsolineLattice lattice{plane};
    lattice.step_mm = step_mm;
    const auto first = [&](double low) { return std::floor(low / step_mm) - 1; };
    const auto nodes = [&](double low, double high) { return std::ceil(high / step_mm) + 2 - first(low); };
    const double columns = nodes(section.min.x, section.max.x), rows = nodes(section.min.y, section.max.y);
    if (!(columns * rows <= static_cast<double>(kMaxNodes)))
        throw Error(ErrorKind::too_large,
                    fmt::format("a sampling step of {:g} mm needs {:g} samples on one plane; the limit is {}", step_mm,
                                columns * rows, kMaxNodes));
    lattice.u_min_mm = first(section.min.x) * step_mm;
    lattice.v_min_mm = first(section.min.y) * step_mm;
    lattice.columns = static_cast<std::int64_t>(columns);
    lattice.rows = static_cast<std::int64_t>(rows);
    return lattice;
}

std::vector<Isoline> isolines(const IsolineLattice& lattice, std::span<const double> values,
                              const std::function<double(double, double)>& exact) {
    check_same_count("values", values.size(), "nodes", static_cast<std::size_t>(lattice.node_count()));
    std::vector<Isoline> lines = MarchingSquares(lattice, values, exact).lines();
    const bool left_handed = dot(cross(lattice.plane.u, lattice.plane.v), lattice.plane.normal) < 0;
    for (Isoline& line : lines) {
        const double area = signed_area(line.points);
        line.area_mm2 = std::abs(area);
        line.hole = area < 0;
        if (left_handed) std::ranges::reverse(line.points);
    }
    return lines;
}

}  // namespace kontur
