// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours/vtk_contours.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/io/geometry/shared_planes.h"
#include "kontur/io/meshes/polydata.h"

namespace kontur {
namespace {

using Position = std::array<double, 3>;

Position position_of(const Vec3& p) { return {p.x + 0.0, p.y + 0.0, p.z + 0.0}; }

struct VtkLine {
    std::vector<Vec3> points;
    bool closed = false;
};

/// Closes a line that comes back to its start.
VtkLine as_line(std::vector<Vec3> points) {
    VtkLine line{std::move(points)};
    line.closed = line.points.size() > 2 && position_of(line.points.front()) == position_of(line.points.back());
    if (line.closed) line.points.pop_back();
    return line;
}

/// Joins lines at points where just two of them end.
class LineJoiner {
public:
    explicit LineJoiner(std::vector<std::vector<Vec3>> lines) : lines_(std::move(lines)), used_(lines_.size()) {
        for (std::size_t n = 0; n < lines_.size(); ++n)
            for (const Vec3* end : {&lines_[n].front(), &lines_[n].back()}) ends_[position_of(*end)].push_back(n);
    }

    std::vector<VtkLine> join() {
        std::vector<VtkLine> joined;
        for (std::size_t n = 0; n < lines_.size(); ++n) {
            if (used_[n]) continue;
            std::vector<Vec3> chain = take(n);
            extend(chain);
            if (position_of(chain.front()) != position_of(chain.back())) {
                std::reverse(chain.begin(), chain.end());
                extend(chain);
                std::reverse(chain.begin(), chain.end());
            }
            joined.push_back(as_line(std::move(chain)));
        }
        return joined;
    }

private:
    std::vector<Vec3> take(std::size_t n) {
        used_[n] = true;
        return std::move(lines_[n]);
    }

    /// Behind its last point, as far as it goes.
    void extend(std::vector<Vec3>& chain) {
        while (const auto next = next_at(position_of(chain.back()))) {
            const Position joint = position_of(chain.back());
            std::vector<Vec3> line = take(*next);
            if (position_of(line.front()) != joint) std::reverse(line.begin(), line.end());
            chain.insert(chain.end(), line.begin() + 1, line.end());
        }
    }

    std::optional<std::size_t> next_at(const Position& joint) const {
        const std::vector<std::size_t>& here = ends_.at(joint);
        if (here.size() != 2) return std::nullopt;
        for (const std::size_t n : here)
            if (!used_[n]) return n;
        return std::nullopt;
    }

    std::vector<std::vector<Vec3>> lines_;
    std::vector<bool> used_;
    std::map<Position, std::vector<std::size_t>> ends_;
};

std::vector<Vec3> points_of(const PolyData& data, std::span<const std::uint32_t> corners) {
    std::vector<Vec3> points;
    for (const std::uint32_t corner : corners) {
        const Vec3 p = to_lps(data.frame, data.points[corner]);
        if (points.empty() || p != points.back()) points.push_back(p);
    }
    return points;
}

std::vector<VtkLine> lines_of(const PolyData& data) {
    std::vector<VtkLine> closed;
    std::vector<std::vector<Vec3>> open;
    for (std::size_t n = 0; n < data.lines.size(); ++n) {
        VtkLine line = as_line(points_of(data, data.lines[n]));
        if (line.closed) closed.push_back(std::move(line));
        else if (line.points.size() > 1) open.push_back(std::move(line.points));
    }
    std::vector<VtkLine> lines = LineJoiner(std::move(open)).join();
    lines.insert(lines.begin(), std::make_move_iterator(closed.begin()), std::make_move_iterator(closed.end()));
    return lines;
}

void refuse_surface(const PolyData& data) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t n = 0; n < data.polygons.size(); ++n) {
        const auto corners = data.polygons[n];
        for (std::size_t c = 0; c < corners.size(); ++c)
            if (!edges.insert(std::minmax(corners[c], corners[(c + 1) % corners.size()])).second)
                throw Error(ErrorKind::unsupported,
                            fmt::format("it holds a surface of {} polygons and no lines; contours are lines, or polygons "
                                        "that share no edges; kontur convert makes a mask of a closed surface, and kontur "
                                        "trace contours of it",
                                        data.polygons.size()));
    }
}

std::vector<VtkLine> polygons_of(const PolyData& data) {
    refuse_surface(data);
    std::vector<VtkLine> lines;
    for (std::size_t n = 0; n < data.polygons.size(); ++n) {
        VtkLine line{points_of(data, data.polygons[n]), true};
        if (line.points.size() > 1 && line.points.front() == line.points.back()) line.points.pop_back();
        lines.push_back(std::move(line));
    }
    return lines;
}

Contour to_contour(VtkLine line) {
    const std::size_t least = line.closed ? 3 : 2;
    if (line.points.size() < least)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("has {}; at least {} are needed", counted(line.points.size(), "point"), least));
    Contour contour;
    contour.closed = line.closed;
    contour.points = std::move(line.points);
    return contour;
}

void check_planar(const Contour& contour, double tolerance_mm) {
    double off_plane = 0;
    for (const Vec3& p : contour.points) off_plane = std::max(off_plane, std::abs(contour.plane.distance_to(p)));
    if (!(off_plane <= tolerance_mm))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("is not planar: points lie up to {:.6g} mm off the plane fitted to it; the limit is {:g} mm",
                                off_plane, tolerance_mm));
}

/// An Error of `body(contour)` names the contour, from 1.
template <class Items, class Body>
void for_each_contour(Items& items, const Body& body) {
    for (std::size_t n = 0; n < items.size(); ++n) try {
            body(items[n]);
        } catch (const Error& error) {
            throw error.with_context(fmt::format("contour {}", n + 1));
        }
}

VtkContours contours_of(const PolyData& data, double tolerance_mm) {
    VtkContours found;
    if (data.lines.size() == 0 && data.polygons.size() == 0 && data.strips.size() == 0)
        throw Error(ErrorKind::invalid_input, "it has no lines");
    std::vector<VtkLine> lines = data.lines.size() > 0 ? lines_of(data) : polygons_of(data);
    std::vector<Contour>& contours = found.contours.contours;
    for_each_contour(lines, [&](VtkLine& line) { contours.push_back(to_contour(std::move(line))); });
    assign_planes(contours, tolerance_mm);
    for_each_contour(contours, [&](const Contour& contour) { check_planar(contour, tolerance_mm); });
    if (!data.names_frame)
        found.notes.emplace_back("the file does not say whether its points are in LPS or RAS; they are taken for LPS");
    const auto open = std::count_if(contours.begin(), contours.end(), [](const Contour& c) { return !c.closed; });
    if (open > 0)
        found.notes.push_back(fmt::format("{} line{} not come back to {} start; read as stretches of the object's boundary",
                                          open, open == 1 ? " does" : "s do", open == 1 ? "its" : "their"));
    return found;
}

}  // namespace

VtkContours read_vtk_contours(const std::filesystem::path& path, double plane_tolerance_mm) {
    const PolyData data = read_polydata(path);
    try {
        return contours_of(data, plane_tolerance_mm);
    } catch (const Error& error) {
        throw error.with_context(path.string());
    }
}

bool has_vtk_lines(const std::filesystem::path& path) {
    try {
        return read_polydata(path).lines.size() > 0;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace kontur
