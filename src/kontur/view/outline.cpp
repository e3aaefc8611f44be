// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/outline.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace kontur {
namespace {

/// Where the line through two points on different sides meets the plane, given their distances to it.
Vec3 meeting_point(const Vec3& p, double distance_p, const Vec3& q, double distance_q) {
    return p + (distance_p / (distance_p - distance_q)) * (q - p);
}

/// The cut as a graph: one node per crossed mesh edge, one segment per crossed triangle.
class CutGraph {
public:
    CutGraph(const TriangleMesh& mesh, const Plane& plane) : mesh_(mesh) {
        distances_.reserve(mesh.points.size());
        for (const Vec3& p : mesh.points) distances_.push_back(plane.distance_to(p));
        for (const auto& t : mesh.triangles) cut(t);
    }

    std::vector<Polyline> lines() {
        std::vector<Polyline> result;
        // Lines that end at the mesh's border are walked first, from their ends; what remains are loops.
        for (const bool from_ends : {true, false})
            for (std::size_t s = 0; s < segments_.size(); ++s)
                for (const int end : {0, 1}) {
                    if (is_walked_[s] || (from_ends && segments_of_[segments_[s][end]].size() % 2 == 0)) continue;
                    if (auto line = walk(s, segments_[s][end])) result.push_back(*std::move(line));
                }
        return result;
    }

private:
    using Node = std::uint32_t;

    void cut(const std::array<std::uint32_t, 3>& t) {
        std::array<Node, 2> ends{};
        int count = 0;
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = t[side], b = t[(side + 1) % 3];
            if ((distances_[a] >= 0) != (distances_[b] >= 0)) ends[count++] = node(std::min(a, b), std::max(a, b));
        }
        if (count != 2 || ends[0] == ends[1]) return;
        for (const Node end : ends) segments_of_[end].push_back(segments_.size());
        segments_.push_back(ends);
        is_walked_.push_back(false);
    }

    Node node(std::uint32_t a, std::uint32_t b) {
        const auto [it, is_new] = nodes_.try_emplace(std::uint64_t{a} << 32 | b, static_cast<Node>(points_.size()));
        if (is_new) {
            points_.push_back(meeting_point(mesh_.points[a], distances_[a], mesh_.points[b], distances_[b]));
            segments_of_.emplace_back();
        }
        return it->second;
    }

    std::optional<std::size_t> unwalked_segment(Node n) const {
        for (const std::size_t s : segments_of_[n])
            if (!is_walked_[s]) return s;
        return std::nullopt;
    }

    std::optional<Polyline> walk(std::size_t first, Node start) {
        Polyline line;
        Node at = start;
        append(line, at);
        for (std::optional<std::size_t> s = first; s; s = unwalked_segment(at)) {
            is_walked_[*s] = true;
            at = segments_[*s][0] == at ? segments_[*s][1] : segments_[*s][0];
            if (at == start) {
                line.closed = true;
                break;
            }
            append(line, at);
        }
        if (line.closed && line.points.size() > 1 && line.points.front() == line.points.back()) line.points.pop_back();
        if (line.points.size() < (line.closed ? 3u : 2u)) return std::nullopt;
        return line;
    }

    /// Mesh points on the plane are met once per edge that ends there; one of them is enough.
    void append(Polyline& line, Node n) const {
        if (line.points.empty() || line.points.back() != points_[n]) line.points.push_back(points_[n]);
    }

    const TriangleMesh& mesh_;
    std::vector<double> distances_;
    std::unordered_map<std::uint64_t, Node> nodes_;
    std::vector<Vec3> points_;
    std::vector<std::vector<std::size_t>> segments_of_;
    std::vector<std::array<Node, 2>> segments_;
    std::vector<bool> is_walked_;
};

}  // namespace

std::vector<Polyline> outline(const TriangleMesh& mesh, const Plane& plane) {
    check_mesh(mesh);
    return CutGraph(mesh, plane).lines();
}

std::vector<Vec3> crossings(const Contour& contour, const Plane& plane) {
    std::vector<Vec3> result;
    const std::size_t count = contour.points.size();
    for (std::size_t i = contour.closed ? 0 : 1; i < count; ++i) {
        const Vec3 &p = contour.points[(i + count - 1) % count], &q = contour.points[i];
        const double distance_p = plane.distance_to(p), distance_q = plane.distance_to(q);
        if ((distance_p >= 0) != (distance_q >= 0)) result.push_back(meeting_point(p, distance_p, q, distance_q));
    }
    return result;
}

}  // namespace kontur
