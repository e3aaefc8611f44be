// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/same_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/error.h"
#include "viewer/images/views.h"

namespace kontur::viewer {
namespace {

/// Normals of the faces of both boxes, and what is across an edge of each: convex bodies that do not meet are apart along
/// one of these (the separating axes of two parallelepipeds).
std::vector<Vec3> separating_axes(const Grid& a, const Grid& b) {
    std::vector<Vec3> axes;
    const auto add = [&](const Vec3& u, const Vec3& v) {
        const Vec3 across = cross(u, v);
        if (norm(across) > 1e-6 * norm(u) * norm(v)) axes.push_back(normalized(across));
    };
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        add(a.index_to_mm.column(i), a.index_to_mm.column(j));
        add(b.index_to_mm.column(i), b.index_to_mm.column(j));
        for (int k = 0; k < 3; ++k) add(a.index_to_mm.column(i), b.index_to_mm.column(k));
    }
    return axes;
}

std::pair<double, double> extent_along(const Vec3& axis, const std::array<Vec3, 8>& corners) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Vec3& corner : corners) {
        least = std::min(least, dot(corner, axis));
        most = std::max(most, dot(corner, axis));
    }
    return {least, most};
}

void refuse_where_apart(const OpenedImage& first, const OpenedImage& second) {
    if (const double gap = gap_mm(first.image->grid, second.image->grid); gap > 0)
        throw Error(ErrorKind::invalid_input, fmt::format("{} and {} do not meet: they lie {:.0f} mm apart or more",
                                                          second.title, first.title, std::max(std::floor(gap), 1.0)));
}

}  // namespace

double gap_mm(const Grid& a, const Grid& b) {
    const auto corners_a = outer_corners(a), corners_b = outer_corners(b);
    double widest = -std::numeric_limits<double>::infinity();
    for (const Vec3& axis : separating_axes(a, b)) {
        const auto [least_a, most_a] = extent_along(axis, corners_a);
        const auto [least_b, most_b] = extent_along(axis, corners_b);
        widest = std::max({widest, least_a - most_b, least_b - most_a});
    }
    return widest;
}

std::vector<std::string> assumptions_of_one_space(const OpenedImage& first, const OpenedImage& second) {
    const std::string &uid = first.frame_of_reference_uid, &other = second.frame_of_reference_uid;
    if (!uid.empty() && !other.empty() && uid != other)
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("{} has another frame of reference ({}) than {} ({}): how they lie to each other is not known",
                        second.title, other, first.title, uid));
    refuse_where_apart(first, second);
    std::vector<std::string> sentences;
    if (uid.empty() && other.empty())
        sentences.push_back(
            fmt::format("Neither {} nor {} names a frame of reference: both are taken to lie in one patient space.",
                        first.title, second.title));
    else if (uid.empty() || other.empty())
        sentences.push_back(fmt::format("{} names no frame of reference: it is taken to lie in the patient space of {}.",
                                        (uid.empty() ? first : second).title, (uid.empty() ? second : first).title));
    const std::string &patient = first.identity.patient_id, &other_patient = second.identity.patient_id;
    if (!patient.empty() && !other_patient.empty() && patient != other_patient)
        sentences.push_back(fmt::format("{} is of the patient with ID {}, {} of the one with ID {}.", second.title,
                                        other_patient, first.title, patient));
    return sentences;
}

}  // namespace kontur::viewer
