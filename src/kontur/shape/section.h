// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "kontur/shape/box_tree.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/predicates.h"

namespace kontur {

/// What a closed polygon encloses, mm2.
double area(const Polygon2& outline);
/// Length of all its edges, mm.
double perimeter(const Polygon2& outline);
/// To the closed segment from a to b.
double distance_to_segment(const Point2& p, const Point2& a, const Point2& b);

/// Where a closed polygon crosses each of `rows` horizontal lines, from `first_mm` on in steps of `step_mm` > 0: sorted, an
/// even number in each. An edge is asked in the rows that it spans alone; drawn in both directions it crosses at the same
/// bits.
std::vector<std::vector<double>> row_crossings(const Polygon2& outline, double first_mm, double step_mm, int rows);

/// The contours drawn in one plane, as the region that they enclose: where more of them than holes lie around a point; each
/// by itself by the even-odd rule. So what is drawn twice is there once. In the plane's (u, v), mm.
struct Section {
    Plane plane;
    std::vector<Polygon2> outlines;
    std::vector<std::size_t> contours;  ///< for each outline, which contour of the set it is
    std::vector<bool> holes;            ///< for each outline, whether it is a hole; without any, none is

    /// A point of an outline; without outlines the distance is infinite.
    struct Nearest {
        double distance = std::numeric_limits<double>::infinity();
        Point2 position{};
        std::size_t outline = 0;
        std::size_t end = 0;  ///< the point of the outline that its edge leads to
    };

    /// What the outline adds to the contours around a point in it.
    int layer(std::size_t outline) const { return outline < holes.size() && holes[outline] ? -1 : 1; }

    bool contains(const Point2& p) const;
    Nearest nearest(const Point2& p) const;
    /// Distance to the nearest outline; infinity without outlines.
    double clearance(const Point2& p) const { return nearest(p).distance; }
};

/// What one closed contour encloses, in the coordinates of a plane that it lies in.
Section section_of(const Contour& contour, const Plane& plane);

/// Answers as a section does, to the last bit, but looks only at the stretches of its outlines that matter: for many
/// points. A point costs about the logarithm of the number of outlines, where few of them lie in each other. The section
/// must outlive it.
class SectionSearch {
public:
    explicit SectionSearch(const Section& section);

    bool contains(const Point2& p) const;
    Section::Nearest nearest(const Point2& p) const;
    double clearance(const Point2& p) const { return nearest(p).distance; }

    /// Calls visit(outline) for those in which p lies, in no particular order.
    template <class Visit>
    void visit_around(const Point2& p, const Visit& visit) const {
        outline_tree_.visit_around(p, [&](std::size_t outline) {
            if (encloses(outline, p)) visit(outline);
        });
    }

private:
    /// The edges that end in [begin, end) of an outline, and their box.
    struct Stretch {
        std::size_t outline, begin, end;
        Box2 box;
    };

    bool encloses(std::size_t outline, const Point2& p) const;

    const Section& section_;
    std::vector<Stretch> stretches_;
    std::vector<std::size_t> first_stretch_;  ///< of every outline, and behind the last
    BoxTree outline_tree_, stretch_tree_;
};

/// The set's closed contours by plane (shared_planes with that tolerance), in the order of the first contour of each. Where
/// they are holes is taken from them: apply_fill_rule. A section's plane has its origin amid its outlines, wherever those of
/// its contours have theirs.
std::vector<Section> sections_of(const ContourSet& set, double tolerance_mm);

/// Whether two planes follow each other in a stack: tilted against each other by less than 6 degrees.
bool are_parallel(const Plane& a, const Plane& b);

}  // namespace kontur
