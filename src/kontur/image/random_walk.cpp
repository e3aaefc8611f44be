// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/random_walk.h"

#include <cmath>
#include <numeric>

namespace kontur {
namespace {

constexpr int kMostSteps = 1000;

std::vector<double> diagonal_of(const std::vector<WalkPlace>& places) {
    std::vector<double> diagonal;
    for (const WalkPlace& place : places)
        diagonal.push_back(std::accumulate(place.weight.begin(), place.weight.end(), place.ends));
    return diagonal;
}

void multiply(const std::vector<WalkPlace>& places, const std::vector<double>& diagonal, const std::vector<double>& x,
              std::vector<double>& product) {
    for (std::size_t n = 0; n < places.size(); ++n) {
        const WalkPlace& place = places[n];
        double sum = diagonal[n] * x[n];
        for (std::size_t side = 0; side < place.next.size(); ++side)
            if (place.next[side] != WalkPlace::kNowhere)
                sum -= static_cast<double>(place.weight[side]) * x[static_cast<std::size_t>(place.next[side])];
        product[n] = sum;
    }
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

}  // namespace

std::vector<double> walk_inside(const std::vector<WalkPlace>& places, double tolerance, const Work& work) {
    const std::size_t count = places.size();
    const std::vector<double> diagonal = diagonal_of(places);
    // From what each place's own ends say, which is near the answer where most walks end soon.
    std::vector<double> x(count), residual(count), preconditioned(count), direction(count), along(count);
    double aim = 0;
    for (std::size_t n = 0; n < count; ++n) {
        x[n] = places[n].ends > 0 ? places[n].ends_inside / places[n].ends : 0.5;
        aim += places[n].ends * places[n].ends;
    }
    multiply(places, diagonal, x, along);
    for (std::size_t n = 0; n < count; ++n) {
        residual[n] = places[n].ends_inside - along[n];
        direction[n] = preconditioned[n] = residual[n] / diagonal[n];
    }
    double rest = product(residual, preconditioned);
    for (int step = 0; step < kMostSteps && product(residual, residual) > tolerance * tolerance * aim; ++step) {
        work.check();
        multiply(places, diagonal, direction, along);
        const double length = rest / product(direction, along);
        for (std::size_t n = 0; n < count; ++n) {
            x[n] += length * direction[n];
            residual[n] -= length * along[n];
            preconditioned[n] = residual[n] / diagonal[n];
        }
        const double next = product(residual, preconditioned);
        for (std::size_t n = 0; n < count; ++n) direction[n] = preconditioned[n] + next / rest * direction[n];
        rest = next;
    }
    return x;
}

}  // namespace kontur
