// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/solver_setup.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "kontur/solve/nearest_points.h"

namespace kontur {
namespace {

// Of the centres, how many may be left out or added. Half and twice as many change a fit's time by .02 at most.
constexpr double kMostOthers = 1.0 / 64;
constexpr std::int32_t kHeirs = 32;  // neighbours that take over the weight of a centre left out; half: an iteration more

std::array<double, 3> key(const Vec3& p) { return {p.x, p.y, p.z}; }

void append(const Vec3& centre, LinearSystem& system) {
    system.centers.x.push_back(centre.x);
    system.centers.y.push_back(centre.y);
    system.centers.z.push_back(centre.z);
    for (auto* of_centre : {&system.smoothing, &system.values, &system.start}) of_centre->push_back(0);
}

/// The weight of a centre goes to its neighbours, so that sums farther off stay what they are.
void hand_over(std::size_t centre, LinearSystem& system) {
    const double weight = std::exchange(system.start[centre], 0.0);
    if (weight == 0) return;
    std::vector<std::int32_t> columns = nearest_points(system.centers, system.centers[centre], kHeirs,
                                                       [&](std::size_t i) { return !system.is_left_out(i); });
    columns.push_back(static_cast<std::int32_t>(centre));
    const std::vector<double> shares = shares_of_neighbours(system.kernel, system.centers, columns, system.smoothing);
    for (std::size_t n = 0; n < shares.size(); ++n) system.start[static_cast<std::size_t>(columns[n])] += weight * shares[n];
}

/// The centres of the setup, all left out.
LinearSystem system_of(std::shared_ptr<const SolverSetup> setup) {
    const std::size_t size = setup->centers.size();
    LinearSystem system{Kernel::screened, std::vector<double>(size, kLeftOut), setup->centers,
                        std::vector<double>(size, 0.0)};
    system.start = setup->weights;
    system.setup = std::move(setup);
    return system;
}

/// Of a system, how many rows are not those that its setup was made for.
std::size_t count_others(const LinearSystem& system) {
    const std::vector<double>& before = system.setup->smoothing;
    std::size_t others = system.size() - system.setup->first_centers;
    for (std::size_t i = 0; i < before.size(); ++i) others += system.is_left_out(i) || system.smoothing[i] != before[i];
    return others;
}

}  // namespace

std::optional<SharedSystem> share(const LinearSystem& system, std::shared_ptr<const SolverSetup> setup) {
    if (system.kernel != Kernel::screened) return std::nullopt;
    SharedSystem shared{system_of(std::move(setup)), {}};
    LinearSystem& all = shared.system;
    std::map<std::array<double, 3>, std::size_t> numbers;
    for (std::size_t i = 0; i < all.size(); ++i) numbers.emplace(key(all.centers[i]), i);
    for (std::size_t i = 0; i < system.size(); ++i) {
        const auto [entry, is_new] = numbers.emplace(key(system.centers[i]), all.size());
        const std::size_t place = entry->second;
        shared.places.push_back(place);
        if (is_new) append(system.centers[i], all);
        all.smoothing[place] = system.smoothing[i];
        all.values[place] = system.values[i];
    }
    if (static_cast<double>(count_others(all)) > kMostOthers * static_cast<double>(system.size())) return std::nullopt;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all.is_left_out(i)) hand_over(i, all);
    return shared;
}

}  // namespace kontur
