// SPDX-License-Identifier: Apache-2.0
#include "kontur/sampling/sample_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kontur/sampling/edge_crossings.h"

namespace kontur {
namespace {

/// Where a running sum passes one place in each of `count` equal steps. The places lie elsewhere in every step, or they
/// would keep time with the rows of the lattice.
class EqualSteps {
public:
    EqualSteps(double total, std::size_t count) : step_(total / static_cast<double>(count)) {}
    /// Adds to the sum; true when that passed a place.
    bool passes(double more) {
        sum_ += more;
        const std::size_t before = passed_;
        while (sum_ >= place()) ++passed_;
        return passed_ > before;
    }

private:
    double place() const {
        constexpr double kGoldenRatio = 0.6180339887498949;
        const auto n = static_cast<double>(passed_);
        return (n + std::fmod(0.5 + n * kGoldenRatio, 1.0)) * step_;
    }

    double step_, sum_ = 0;
    std::size_t passed_ = 0;
};

Vec3 newton_step(double value, const Vec3& gradient, double most_mm) {
    const double slope = norm(gradient);
    if (!(slope > 0)) return {};
    return std::clamp(-value / slope, -most_mm, most_mm) * normalized(gradient);
}

}  // namespace

double SurfaceSamples::area_mm2() const { return std::accumulate(areas_mm2.begin(), areas_mm2.end(), 0.0); }

SurfaceSamples sample_surface(const SurfaceLattice& surface, const ImplicitFunction& function, std::size_t most,
                              const Work& work) {
    const EdgeCrossings crossings(surface);
    double total = 0;
    std::size_t count = 0;
    crossings.visit([&](const Vec3&, double measure) {
        total += measure;
        ++count;
    });
    SurfaceSamples samples;
    most = std::min(most, count);
    if (most == 0) return samples;
    EqualSteps steps(total, most);
    crossings.visit([&](const Vec3& point, double measure) {
        if (steps.passes(measure)) samples.points.push_back(point);
    });

    std::vector<double> values(samples.points.size());
    std::vector<Vec3> gradients(samples.points.size());
    function.values_and_gradients(samples.points, values, gradients, work);
    const double measure = total / static_cast<double>(samples.points.size());
    for (std::size_t n = 0; n < samples.points.size(); ++n) {
        samples.points[n] += newton_step(values[n], gradients[n], crossings.step_mm());
        samples.areas_mm2.push_back(measure / std::max(crossings.density(normalized(gradients[n])), 0.5));
        samples.slopes.push_back(norm(gradients[n]));
    }
    return samples;
}

SurfaceSamples sample_surface(const TriangleMesh& mesh, const ImplicitFunction& function, std::size_t most,
                              const Work& work) {
    // Fractions of the plastic number's powers fill a square evenly (Roberts 2018).
    constexpr double kAlongU = 0.7548776662466927, kAlongV = 0.5698402909980532;
    const auto area_vector = [&](const std::array<std::uint32_t, 3>& t) {
        return 0.5 * cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
    };
    double total = 0;
    for (const auto& t : mesh.triangles) total += norm(area_vector(t));
    SurfaceSamples samples;
    if (!(total > 0) || most == 0) return samples;
    const double step = total / static_cast<double>(most);
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        sum += norm(area_vector(t));
        while (samples.points.size() < most && sum >= (static_cast<double>(samples.points.size()) + 0.5) * step) {
            const auto n = static_cast<double>(samples.points.size());
            double u = std::fmod(0.5 + n * kAlongU, 1.0), v = std::fmod(0.5 + n * kAlongV, 1.0);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            samples.points.push_back(mesh.points[t[0]] + u * (mesh.points[t[1]] - mesh.points[t[0]]) +
                                     v * (mesh.points[t[2]] - mesh.points[t[0]]));
        }
    }
    std::vector<Vec3> gradients(samples.points.size());
    function.gradients(samples.points, gradients, work);
    samples.areas_mm2.assign(samples.points.size(), total / static_cast<double>(samples.points.size()));
    for (const Vec3& gradient : gradients) samples.slopes.push_back(norm(gradient));
    return samples;
}

}  // namespace kontur
