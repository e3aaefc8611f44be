// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kontur/base/counted.h"
#include "kontur/base/pick.h"
#include "kontur/drawing/one_line.h"
#include "kontur/drawing/tidy.h"
#include "kontur/shape/apply_fill_rule.h"
#include "kontur/shape/repeated_contours.h"

namespace kontur {
namespace {

void note_filling(const FillChanges& changes, std::vector<std::string>& notes) {
    if (changes.holes > 0)
        notes.push_back(counted(changes.holes, "contour") +
                        (changes.holes == 1 ? " inside another became a hole" : " inside others became holes"));
    if (changes.removed > 0)
        notes.push_back(counted(changes.removed, "contour") +
                        (changes.removed == 1 ? " inside the object was left out: it is no hole"
                                              : " inside the object were left out: they are not holes"));
    if (!changes.stray_holes.empty())
        notes.push_back(
            changes.stray_holes.size() == 1
                ? fmt::format("contour {} is a hole where nothing is drawn around it", changes.stray_holes.front() + 1)
                : fmt::format("{} contours are holes where nothing is drawn around them, the first of them contour {}",
                              changes.stray_holes.size(), changes.stray_holes.front() + 1));
    if (!changes.crossings.empty()) notes.push_back(overlap_sentence(changes.crossings));
}

/// The number that each contour had before some were left out; they keep their order and first points.
std::vector<std::size_t> numbers_before(const std::vector<Vec3>& first_points, const ContourSet& set) {
    std::vector<std::size_t> numbers;
    std::size_t n = 0;
    for (const Contour& contour : set.contours) {
        while (n + 1 < first_points.size() && first_points[n] != contour.points.front()) ++n;
        numbers.push_back(n++);
    }
    return numbers;
}

std::vector<NearLines> numbered(std::vector<NearLines> pairs, const std::vector<std::size_t>& numbers) {
    for (NearLines& pair : pairs) {
        pair.contour = numbers[pair.contour];
        pair.other = numbers[pair.other];
    }
    return pairs;
}

std::vector<Vec3> first_points(const ContourSet& set) {
    std::vector<Vec3> points;
    for (const Contour& contour : set.contours) points.push_back(contour.points.empty() ? Vec3{} : contour.points.front());
    return points;
}

/// One sentence on the pairs that were read so, with the first of them; none without any.
void note_near_lines(const std::vector<NearLines>& all, bool is_one, std::vector<std::string>& notes) {
    std::vector<NearLines> pairs;
    std::ranges::copy_if(all, std::back_inserter(pairs), [&](const NearLines& pair) { return pair.is_one == is_one; });
    if (pairs.empty()) return;
    const std::string others = pairs.size() == 1 ? "" : " (and " + counted(pairs.size() - 1, "more such pair") + ")";
    const NearLines& first = pairs.front();
    notes.push_back(
        is_one
            ? fmt::format("contours {} and {}, {:.2g} mm apart, were taken for one line that was drawn twice{}, and the "
                          "surface passes between them; where a wall is meant, mark the inner one as a hole",
                          first.other + 1, first.contour + 1, first.apart_mm, others)
            : fmt::format("contour {} became a hole, which leaves a wall of {:.2g} mm within contour {}{}; where it is "
                          "the same line drawn again, remove one of the two, and where a wall is meant, mark it as a hole",
                          first.contour + 1, first.apart_mm, first.other + 1, others));
}

/// Closed contours as small as a slip of the hand, where there are others: their plane would say that it is empty but for
/// them.
void leave_out_specks(ContourSet& set, const std::vector<Vec3>& first_points, std::vector<std::string>& notes) {
    constexpr double kSpeck = 3e-4;  // of what the largest is across
    const std::size_t count = set.contours.size();
    std::vector<double> across_mm;
    for (const Contour& contour : set.contours) across_mm.push_back(smallest_ball(contour.points).diameter());
    const double least_mm = count > 0 ? kSpeck * std::ranges::max(across_mm) : 0;
    const auto is_speck = [&](std::size_t c) { return set.contours[c].closed && across_mm[c] < least_mm; };
    std::size_t first = 0;
    while (first < count && !is_speck(first)) ++first;
    if (first == count) return;
    const std::size_t number = numbers_before(first_points, set)[first] + 1;
    std::vector<Contour> others;
    for (std::size_t c = 0; c < count; ++c)
        if (!is_speck(c)) others.push_back(set.contours[c]);
    const std::size_t left_out = count - others.size();
    const double first_mm = across_mm[first];
    set.contours = std::move(others);
    notes.push_back(left_out == 1 ? fmt::format("contour {} is {:.2g} mm across and was left out", number, first_mm)
                                  : fmt::format("{} contours less than {:.2g} mm across were left out, the first of them "
                                                "contour {}",
                                                left_out, least_mm, number));
}

/// Contours that run back along themselves enclose nothing. Where there are no others, `tidy` refuses them.
void leave_out_spikes(ContourSet& set, double spike_tolerance_mm, std::vector<std::string>& notes) {
    const auto is_nothing = [&](const Contour& contour) { return is_only_spikes(contour, spike_tolerance_mm); };
    if (std::none_of(set.contours.begin(), set.contours.end(),
                     [&](const Contour& contour) { return !contour.hole && !is_nothing(contour); }))
        return;
    const std::size_t left_out = std::erase_if(set.contours, is_nothing);
    if (left_out > 0)
        notes.push_back(left_out == 1 ? "1 contour that runs back along itself, and encloses nothing, was left out"
                                      : counted(left_out, "contour") +
                                            " that run back along themselves, and enclose nothing, were left out");
}

/// Contours that are thinned begin elsewhere: the first points of all say so.
TidyReport thin_vast(ContourSet& set, std::vector<Vec3>& first_points, const TidyOptions& options) {
    const std::vector<std::size_t> numbers = numbers_before(first_points, set);
    const TidyReport report = thin_vast(set, options);
    for (std::size_t c = 0; c < set.contours.size(); ++c) first_points[numbers[c]] = set.contours[c].points.front();
    return report;
}

/// Of different contours: those that were thinned have too few points to be thinned again.
TidyReport sum(const TidyReport& a, const TidyReport& b) {
    return {a.spike_points + b.spike_points, a.thinned_contours + b.thinned_contours, a.thinned_points + b.thinned_points,
            std::max(a.thinned_mm, b.thinned_mm)};
}

void note_tidying(const TidyReport& report, std::vector<std::string>& notes) {
    if (report.spike_points > 0)
        notes.push_back(counted(report.spike_points, "point") + (report.spike_points == 1
                                                                     ? " of a spike, which encloses nothing, was left out"
                                                                     : " of spikes, which enclose nothing, were left out"));
    if (report.thinned_contours > 0)
        notes.push_back(
            fmt::format("{} with very many points {} thinned: {} left out, none farther than "
                        "{:.2g} mm from the contour that was kept",
                        counted(report.thinned_contours, "contour"), report.thinned_contours == 1 ? "was" : "were",
                        counted(report.thinned_points, "point"), report.thinned_mm));
}

}  // namespace

Drawing::Drawing(ContourSet drawn, FillRule rule) : contours(std::move(drawn)) {
    if (const std::size_t repeated = drop_duplicate_points(contours); repeated > 0)
        notes.push_back(counted(repeated, "repeated point") + (repeated == 1 ? " was left out" : " were left out"));
    std::vector<Vec3> first = first_points(contours);
    for (std::string& note : check_and_tidy(contours)) notes.push_back(std::move(note));
    const double drawn_mm = smallest_ball(contours).diameter();
    const TidyOptions tidy_options{1.5e-5 * drawn_mm, 1.5e-4 * drawn_mm};
    const std::size_t all_points = point_count(contours);
    const TidyReport vast = thin_vast(contours, first, tidy_options);
    const std::size_t left_out = all_points - point_count(contours);
    leave_out_specks(contours, first, notes);
    leave_out_spikes(contours, tidy_options.spike_tolerance_mm, notes);
    const FillChanges changes = apply_fill_rule(contours, rule);
    note_filling(changes, notes);
    numbers = numbers_before(first, contours);
    near_lines = numbered(changes.near_lines, numbers);
    for (const bool is_one : {true, false}) note_near_lines(near_lines, is_one, notes);
    numbers = pick(numbers, make_one_line(contours, changes.near_lines));
    crossings = find_crossings(contours);
    tidied = contours;
    points_drawn = point_count(contours) + left_out;
    note_tidying(sum(vast, tidy(tidied, tidy_options)), notes);
    ball = smallest_ball(tidied);
}

}  // namespace kontur
