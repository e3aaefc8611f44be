// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kontur/base/counted.h"
#include "kontur/drawing/tidy.h"
#include "kontur/shape/repeated_contours.h"

namespace kontur {
namespace {

void note_filling(const FillChanges& changes, std::vector<std::string>& notes) {
    if (changes.holes > 0)
        notes.push_back(counted(changes.holes, "contour") +
                        (changes.holes == 1 ? " inside another became a hole" : " inside others became holes"));
    if (!changes.thin_rings.empty())
        notes.push_back(fmt::format(
            "{} less than a tenth of the contour around them, the first of them contour {} "
            "inside contour {}; where it is the same line drawn again, remove one of the two",
            changes.thin_rings.size() == 1 ? "1 hole leaves" : counted(changes.thin_rings.size(), "hole") + " leave",
            changes.thin_rings.front().first + 1, changes.thin_rings.front().second + 1));
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
    for (const auto& [a, b] : changes.crossings)
        notes.push_back(fmt::format("contours {} and {} overlap in part", a + 1, b + 1));
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

void note_tidied(const Tidied& tidied, std::vector<std::string>& notes) {
    if (tidied.spike_points > 0)
        notes.push_back(counted(tidied.spike_points, "point") + (tidied.spike_points == 1
                                                                     ? " of a spike, which encloses nothing, was left out"
                                                                     : " of spikes, which enclose nothing, were left out"));
    if (tidied.thinned_contours > 0)
        notes.push_back(
            fmt::format("{} with very many points {} thinned: {} left out, none farther than "
                        "{:.2g} mm from the contour that was kept",
                        counted(tidied.thinned_contours, "contour"), tidied.thinned_contours == 1 ? "was" : "were",
                        counted(tidied.thinned_points, "point"), tidied.thinned_mm));
}

}  // namespace

Drawing::Drawing(ContourSet drawn, FillRule rule) : contours(std::move(drawn)) {
    if (const std::size_t dropped = drop_duplicate_points(contours); dropped > 0)
        notes.push_back(counted(dropped, "repeated point") + (dropped == 1 ? " was left out" : " were left out"));
    for (std::string& note : check_and_tidy(contours)) notes.push_back(std::move(note));
    const double drawn_mm = smallest_ball(contours).diameter();
    const TidyOptions tidy_options{1.5e-5 * drawn_mm, 1.5e-4 * drawn_mm};
    leave_out_spikes(contours, tidy_options.spike_tolerance_mm, notes);
    note_filling(apply_fill_rule(contours, rule), notes);
    crossings = find_crossings(contours);
    tidied = contours;
    note_tidied(tidy(tidied, tidy_options), notes);
    ball = smallest_ball(tidied);
}

}  // namespace kontur
