// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/measure/compare.h"
#include "kontur/measure/differences.h"
#include "viewer/files/structure_exports.h"
#include "viewer/model/model_json.h"
#include "viewer/model/status_line.h"
#include "viewer/session/replies.h"

// Two structures, or two readers' drawings of one.

namespace kontur::viewer {
namespace {

constexpr std::size_t kMostDifferences = 200;  ///< that somebody goes through

nlohmann::json to_json(const std::vector<Difference>& all) {
    nlohmann::json list = nlohmann::json::array();
    for (const Difference& one : all) {
        if (list.size() == kMostDifferences) break;
        list.push_back({{"at", viewer::to_json(one.at)},
                        {"distance_mm", one.distance_mm},
                        {"volume_ml", one.volume_ml},
                        {"in_first", one.in_first}});
    }
    return list;
}

}  // namespace

std::string comparison_reply(SessionState& s, const Compared& compared, const StopToken& stop) {
    const auto [first, second, time] = compared;
    State now = s.state();
    // Readers are compared by what each has drawn, not by borders that they would share.
    now.borders.shared = false;
    const Structure a = s.present_structure(now, first), b = s.present_structure(now, second);
    if (first == second)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} would be compared with itself; 2 structures are needed", a.name));
    for (const Structure& one : {a, b})
        if (!has_content(now, one.id))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} has 0 contours; at least 1 is needed to compare it", one.name));
    const StatusLine line(s.pages.status_teller(), fmt::format("Comparing {} and {}", a.name, b.name));
    const auto fitted = [&, &at = time](Id id) { return s.fits.one(now, id, line.work(stop), {at, false}); };
    const auto fit_a = fitted(first), fit_b = fitted(second);
    const Comparison found = kontur::compare(fit_a->segmentation.mask, fit_b->segmentation.mask, line.work(stop));
    nlohmann::json reply{{"first", first},
                         {"second", second},
                         {"dice", found.dice},
                         {"jaccard", found.jaccard},
                         {"volumes_ml", {found.volume_a_ml, found.volume_b_ml}},
                         {"mean_mm", nullptr},
                         {"percentile_95_mm", nullptr},
                         {"largest_mm", nullptr}};
    if (found.surface) {
        reply["mean_mm"] = found.surface->mean_surface_distance_mm;
        reply["percentile_95_mm"] = found.surface->hausdorff95_mm;
        reply["largest_mm"] = found.surface->hausdorff_mm;
    }
    reply["differences"] =
        to_json(differences(fit_a->segmentation.mask, fit_b->segmentation.mask, kSaddle, line.work(stop)));
    return to_text(reply);
}

}  // namespace kontur::viewer
