// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "agreement.h"

namespace kontur {
namespace {

/// Another way in which the same drawing may come.
struct Way {
    const char* name;
    std::function<ContourSet(ContourSet)> stored;
    Affine3 motion;  ///< of the drawing as of the image
};

ContourSet reversed(ContourSet set) {
    for (Contour& contour : set.contours)
        if (contour.closed) std::ranges::reverse(contour.points);
    return set;
}

/// Rings that begin a share of their points later.
ContourSet begun_later(ContourSet set, double share) {
    for (Contour& contour : set.contours)
        if (contour.closed)
            std::ranges::rotate(
                contour.points,
                contour.points.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(contour.points.size())));
    return set;
}

/// Contours in another order: every third of them, then the others.
ContourSet in_another_order(const ContourSet& set) {
    ContourSet other = set;
    other.contours.clear();
    for (std::size_t first : {2u, 0u, 1u})
        for (std::size_t c = first; c < set.contours.size(); c += 3) other.contours.push_back(set.contours[c]);
    return other;
}

ContourSet moved(ContourSet set, const Affine3& motion) {
    for (Contour& contour : set.contours) {
        for (Vec3& p : contour.points) p = motion.apply(p);
        contour.plane = make_plane(motion.apply(contour.plane.origin), motion.apply_linear(contour.plane.normal));
    }
    return set;
}

std::vector<Way> ways() {
    const auto as_it_is = [](ContourSet set) { return set; };
    Affine3 mirror, exchange, turn;
    mirror.linear[0][0] = -1;
    exchange.linear = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
    const Plane frame = make_plane({}, {0.3, -0.5, 0.8});
    for (const auto& [axis, to] : {std::pair{0, frame.u}, {1, frame.v}, {2, frame.normal}}) turn.set_column(axis, to);
    turn.translation = {70, -200, 900};
    return {{"reversed", reversed, {}},
            {"begun_a_third_later", [](ContourSet set) { return begun_later(std::move(set), 1.0 / 3); }, {}},
            {"begun_one_later", [](ContourSet set) { return begun_later(std::move(set), 0.03); }, {}},
            {"in_another_order", in_another_order, {}},
            {"mirrored", as_it_is, mirror},
            {"axes_exchanged", as_it_is, exchange},
            {"turned", as_it_is, turn}};
}

}  // namespace

nlohmann::ordered_json agreement_by_storage(const ContourSet& contours, const Mask& truth) {
    const Segmentation first = segment(contours, truth.grid);
    std::vector<double> here(first.samples.points.size());
    first.function.values(first.samples.points, here);
    auto rows = nlohmann::ordered_json::array();
    for (const Way& way : ways()) {
        const Grid grid{truth.grid.size, compose(way.motion, truth.grid.index_to_mm)};
        const Segmentation other = segment(moved(way.stored(contours), way.motion), grid);
        std::vector<Vec3> places = first.samples.points;
        for (Vec3& p : places) p = way.motion.apply(p);
        std::vector<double> there(places.size());
        other.function.values(places, there);
        double most = 0, squares = 0;
        for (std::size_t i = 0; i < here.size(); ++i) {
            most = std::max(most, std::abs(there[i] - here[i]));
            squares += std::pow(there[i] - here[i], 2);
        }
        const Mask as_first{truth.grid, other.mask.values};
        rows.push_back({{"way", way.name},
                        {"dice", compare(as_first, first.mask).dice},
                        {"dice_with_truth_changes", compare(as_first, truth).dice - compare(first.mask, truth).dice},
                        {"rms_mm", std::sqrt(squares / static_cast<double>(std::max<std::size_t>(here.size(), 1)))},
                        {"most_mm", most}});
    }
    return rows;
}

}  // namespace kontur
