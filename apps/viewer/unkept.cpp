// SPDX-License-Identifier: Apache-2.0
#include "viewer/unkept.h"

#include <fmt/format.h>

#include "kontur/base/counted.h"

namespace kontur::viewer {

std::vector<std::string> leave_out_unkept(ContourSet& set) {
    std::vector<std::string> notes;
    std::size_t ends = 0, weights = 0;
    for (Contour& contour : set.contours) {
        ends += contour.end != ContourEnd::automatic;
        weights += contour.weight != 1;
        contour.end = ContourEnd::automatic;
        contour.weight = 1;
    }
    if (ends > 0)
        notes.push_back(
            fmt::format("left out: how the object ends at {}, which the page does not keep", counted(ends, "contour")));
    if (weights > 0)
        notes.push_back(fmt::format("left out: the {}, which the page does not keep; every contour counts as 1",
                                    weights == 1 ? "weight of a contour" : fmt::format("weights of {} contours", weights)));
    return notes;
}

}  // namespace kontur::viewer
