// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/repeated_contours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/shape/least_rotation.h"

namespace kontur {
namespace {

constexpr double kSameOfDiameter = 1e-6;

}  // namespace

bool SeenRings::add(const std::vector<Vec3>& points) { return seen_.insert(canonical(points)).second; }

SeenRings::Ring SeenRings::canonical(const std::vector<Vec3>& points) const {
    const auto rounded = [&](double mm) { return std::round(mm / tolerance_mm_); };
    Ring ring;
    for (const Vec3& p : points)
        if (const std::array at{rounded(p.x), rounded(p.y), rounded(p.z)}; ring.empty() || at != ring.back())
            ring.push_back(at);
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    Ring turned(ring.rbegin(), ring.rend());
    for (Ring* one : {&ring, &turned})
        std::rotate(one->begin(), one->begin() + static_cast<std::ptrdiff_t>(least_rotation(*one)), one->end());
    return std::min(ring, turned);
}

std::vector<std::string> leave_out_repetitions(ContourSet& set) {
    const double same_mm = kSameOfDiameter * diameter_mm(set);
    if (same_mm == 0) return {};
    std::map<std::tuple<bool, ContourEnd, std::optional<double>, std::optional<double>>, SeenRings> seen;
    std::vector<Contour> others;
    std::size_t first = 0, left_out = 0;
    for (std::size_t n = 0; n < set.contours.size(); ++n) {
        Contour& contour = set.contours[n];
        SeenRings& rings =
            seen.try_emplace({contour.hole, contour.end, contour.frame, contour.time_s}, same_mm).first->second;
        if (contour.closed && !rings.add(contour.points)) {
            if (left_out++ == 0) first = n;
        } else {
            others.push_back(std::move(contour));
        }
    }
    set.contours = std::move(others);
    if (left_out == 0) return {};
    return {left_out == 1 ? fmt::format("contour {} repeats one before it and was left out", first + 1)
                          : fmt::format("{} contours that repeat others were left out, the first of them contour {}",
                                        left_out, first + 1)};
}

std::vector<std::string> check_and_tidy_moments(ContourSet& set) {
    if (!is_moving(set)) return check_and_tidy(set);
    if (const std::vector<std::string> problems = contour_problems(set); !problems.empty())
        throw Error(ErrorKind::invalid_input, problems.front());
    std::vector<std::string> notes = leave_out_lines(set);
    for (std::string& note : leave_out_repetitions(set)) notes.push_back(std::move(note));
    return notes;
}

std::vector<std::string> check_and_tidy(ContourSet& set) {
    check_contours(set);
    std::vector<std::string> notes = leave_out_lines(set);
    for (std::string& note : leave_out_repetitions(set)) notes.push_back(std::move(note));
    return notes;
}

}  // namespace kontur
