// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/self_intersections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace kontur {
namespace {

std::size_t after(const Polygon2& polygon, std::size_t i) { return i + 1 < polygon.size() ? i + 1 : 0; }

/// Sign of the difference of two coordinates.
int order(double a, double b) { return (a > b) - (a < b); }

/// Two segments that meet, by their first points.
struct Pair {
    std::size_t first, second;
    Meeting meeting;
    bool crosses;  ///< after the infinitesimal displacement; never for neighbours
};

bool displaced_segments_cross(const Polygon2& polygon, std::size_t i, std::size_t j) {
    const std::size_t a = i, b = after(polygon, i), c = j, d = after(polygon, j);
    return is_left_turn(polygon, a, b, c) != is_left_turn(polygon, a, b, d) &&
           is_left_turn(polygon, c, d, a) != is_left_turn(polygon, c, d, b);
}

/// Whether the path, having gone along segment i, runs back on it.
bool folds_back(const Polygon2& polygon, std::size_t i) {
    const std::size_t j = after(polygon, i);
    const Point2 &a = polygon[i], &b = polygon[j], &c = polygon[after(polygon, j)];
    return orientation(a, b, c) == 0 && (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]) > 0;
}

/// All pairs of segments that meet, neighbours only where the path folds back.
std::vector<Pair> meeting_pairs(const Polygon2& polygon) {
    const std::size_t n = polygon.size();
    const auto low = [&](std::size_t i) { return std::min(polygon[i][0], polygon[after(polygon, i)][0]); };
    const auto high = [&](std::size_t i) { return std::max(polygon[i][0], polygon[after(polygon, i)][0]); };
    std::vector<std::size_t> by_low(n);
    std::iota(by_low.begin(), by_low.end(), std::size_t{0});
    std::sort(by_low.begin(), by_low.end(), [&](std::size_t a, std::size_t b) { return low(a) < low(b); });

    std::vector<Pair> pairs;
    std::vector<std::size_t> active;
    for (const std::size_t i : by_low) {
        std::erase_if(active, [&](std::size_t j) { return high(j) < low(i); });
        for (const std::size_t j : active) {
            if (after(polygon, i) == j || after(polygon, j) == i) continue;
            const Meeting contact = meeting(polygon[i], polygon[after(polygon, i)], polygon[j], polygon[after(polygon, j)]);
            if (contact == Meeting::apart) continue;
            const bool crosses = contact == Meeting::crossing || displaced_segments_cross(polygon, i, j);
            pairs.push_back({std::min(i, j), std::max(i, j), contact, crosses});
        }
        active.push_back(i);
    }
    for (std::size_t i = 0; i < n; ++i)
        if (const std::size_t j = after(polygon, i); folds_back(polygon, i))
            pairs.push_back({std::min(i, j), std::max(i, j), Meeting::touching, false});
    return pairs;
}

/// Fraction of segment i at which it meets the line of segment j.
double fraction(const Polygon2& polygon, std::size_t i, std::size_t j) {
    const Point2 &p = polygon[i], &q = polygon[after(polygon, i)], &a = polygon[j], &b = polygon[after(polygon, j)];
    const auto area = [&](const Point2& c) { return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]); };
    const double from = area(p), to = area(q);
    return from != to ? std::clamp(from / (from - to), 0.0, 1.0) : 0.0;
}

Point2 along(const Polygon2& polygon, std::size_t i, double t) {
    const Point2 &p = polygon[i], &q = polygon[after(polygon, i)];
    return {p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])};
}

/// A point in which two segments touch: one of their ends.
Point2 touching_point(const Polygon2& polygon, const Pair& pair) {
    const Point2 &a = polygon[pair.first], &b = polygon[after(polygon, pair.first)];
    for (const std::size_t end : {pair.second, after(polygon, pair.second)})
        if (is_on_segment(a, b, polygon[end])) return polygon[end];
    return is_on_segment(polygon[pair.second], polygon[after(polygon, pair.second)], a) ? a : b;
}

/// Touching pairs that continue each other, along both parts of the path, are one contact.
class Contacts {
public:
    Contacts(const Polygon2& polygon, const std::vector<Pair>& touching) : polygon_(polygon), pairs_(touching) {
        parent_.resize(pairs_.size());
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
        std::map<std::pair<std::size_t, std::size_t>, std::size_t> index;
        for (std::size_t p = 0; p < pairs_.size(); ++p) index[{pairs_[p].first, pairs_[p].second}] = p;
        for (std::size_t p = 0; p < pairs_.size(); ++p)
            for (const std::size_t i : neighbourhood(pairs_[p].first))
                for (const std::size_t j : neighbourhood(pairs_[p].second))
                    if (const auto entry = index.find(std::minmax(i, j)); entry != index.end())
                        parent_[root(p)] = root(entry->second);
    }

    void append_to(std::vector<SelfIntersection>& contacts) {
        using Kind = SelfIntersection::Kind;
        std::map<std::size_t, SelfIntersection> by_root;
        for (std::size_t p = 0; p < pairs_.size(); ++p) {
            const Pair& pair = pairs_[p];
            const auto [at, is_new] = by_root.try_emplace(
                root(p), SelfIntersection{Kind::touch, touching_point(polygon_, pair), pair.first, pair.second});
            Kind& kind = at->second.kind;
            if (are_neighbours(pair)) kind = Kind::fold;
            // Two parts cross if their displaced copies cross an odd number of times.
            else if (pair.crosses && kind != Kind::fold) kind = kind == Kind::touch ? Kind::crossing : Kind::touch;
        }
        for (const auto& [root, contact] : by_root) contacts.push_back(contact);
    }

private:
    std::array<std::size_t, 3> neighbourhood(std::size_t i) const {
        return {i > 0 ? i - 1 : polygon_.size() - 1, i, after(polygon_, i)};
    }
    bool are_neighbours(const Pair& p) const {
        return after(polygon_, p.first) == p.second || after(polygon_, p.second) == p.first;
    }
    std::size_t root(std::size_t p) {
        while (parent_[p] != p) p = parent_[p] = parent_[parent_[p]];
        return p;
    }

    const Polygon2& polygon_;
    const std::vector<Pair>& pairs_;
    std::vector<std::size_t> parent_;
};

/// Points half way between neighbouring crossings on each segment.
std::vector<Point2> between(const Polygon2& polygon, const std::vector<SelfIntersection>& crossings) {
    std::map<std::size_t, std::vector<double>> by_segment;
    for (const SelfIntersection& c : crossings) {
        by_segment[c.first].push_back(fraction(polygon, c.first, c.second));
        by_segment[c.second].push_back(fraction(polygon, c.second, c.first));
    }
    std::vector<Point2> points;
    for (auto& [segment, fractions] : by_segment) {
        std::sort(fractions.begin(), fractions.end());
        for (std::size_t k = 1; k < fractions.size(); ++k)
            points.push_back(along(polygon, segment, (fractions[k - 1] + fractions[k]) / 2));
    }
    return points;
}

}  // namespace

bool is_left_turn(const Polygon2& polygon, std::size_t a, std::size_t b, std::size_t c) {
    if (const int side = orientation(polygon[a], polygon[b], polygon[c]); side != 0) return side > 0;
    bool even = true;  // a permutation that sorts them by index
    const auto sort = [&](std::size_t& first, std::size_t& second) {
        if (first < second) return;
        std::swap(first, second);
        even = !even;
    };
    sort(a, b);
    sort(b, c);
    sort(a, b);
    const Point2 &p = polygon[a], &q = polygon[b], &r = polygon[c];
    // The area's terms in order of falling size when y_a, x_a, y_b, ... grow by ever smaller amounts.
    for (const int term : {order(r[0], q[0]), order(q[1], r[1]), order(p[0], r[0])})
        if (term != 0) return (term > 0) == even;
    return even;
}

std::size_t extreme_point(const Polygon2& polygon) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < polygon.size(); ++i)
        if (polygon[i][0] <= polygon[best][0]) best = i;
    return best;
}

SelfIntersections find_self_intersections(const Polygon2& polygon) {
    SelfIntersections result;
    result.crossings_of_segment.assign(polygon.size(), 0);
    std::vector<Pair> touching;
    for (const Pair& pair : meeting_pairs(polygon)) {
        result.crossings_of_segment[pair.first] += pair.crosses;
        result.crossings_of_segment[pair.second] += pair.crosses;
        if (pair.meeting == Meeting::touching) touching.push_back(pair);
        else
            result.places.push_back({SelfIntersection::Kind::crossing,
                                     along(polygon, pair.first, fraction(polygon, pair.first, pair.second)), pair.first,
                                     pair.second});
    }
    result.between_crossings = between(polygon, result.places);
    Contacts(polygon, touching).append_to(result.places);
    return result;
}

}  // namespace kontur
