// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/evaluation_plan.h"

#include <algorithm>
#include <cmath>

#include "kontur/function/far_field.h"

namespace kontur {
namespace {

// Costs in units of one value of phi in the direct sum, measured.
constexpr double kNearCost = 1.5;         ///< of a value of the near part
constexpr double kGatheredPerNear = 1.5;  ///< centres gathered per centre within the radius
constexpr double kGatherCost = 5;         ///< of gathering one of them for a cell
constexpr double kCellCost = 8000;        ///< of finding the centres near a cell, and its nodes
constexpr double kVisitsPerCell = 4;      ///< in how many calls a cell's points are asked for
constexpr double kPointCost = 700;        ///< of interpolating at a point
constexpr double kNodeCost = 1500;        ///< of storing a node
constexpr double kStencilLayers = 12;     ///< layers of nodes about a surface that the cells which it passes need
constexpr double kCoarsestSpacing = 0.5;  ///< unit frame
constexpr double kSpacingRatio = 1.4142135623730951;
constexpr int kSpacings = 14;
constexpr int kMostLevels = 4;

/// How many centres lie within a distance of a centre, on average, from a sample of both.
class NeighbourCounts {
public:
    explicit NeighbourCounts(const PointArrays& centers) {
        constexpr std::size_t most_from = 16, most_to = 1024;
        const std::size_t step_from = centers.size() / most_from + 1, step_to = centers.size() / most_to + 1;
        for (std::size_t a = 0; a < centers.size(); a += step_from) {
            for (std::size_t b = 0; b < centers.size(); b += step_to) distances_.push_back(distance(centers[a], centers[b]));
            from_ += 1;
        }
        std::sort(distances_.begin(), distances_.end());
        scale_ = from_ > 0 ? static_cast<double>(step_to) / from_ : 0;
    }
    double within(double radius) const {
        return scale_ *
               static_cast<double>(std::upper_bound(distances_.begin(), distances_.end(), radius) - distances_.begin());
    }

private:
    std::vector<double> distances_;
    double from_ = 0, scale_ = 0;
};

/// Area of a surface through the centres, taken for an ellipsoid that fills their box.
double surface_area(const PointArrays& centers) {
    Box3 box;
    for (std::size_t i = 0; i < centers.size(); ++i) box.extend(centers[i]);
    const Vec3 half = box.size() / 2;
    return 4.0 / 3 * M_PI * (half.x * half.y + half.y * half.z + half.z * half.x);
}

/// Points in a layer about the surface.
struct Layer {
    double points;
    double thickness;
    double visits;
};

class Planner {
public:
    Planner(const ImplicitFunction& function, double coarsest_spacing)
        : coarsest_(static_cast<int>(
              std::lround(std::log(std::max(kCoarsestSpacing / coarsest_spacing, 1.0)) / std::log(kSpacingRatio)))),
          centers_(static_cast<double>(function.centers().size())),
          area_(surface_area(function.centers())),
          neighbours_(function.centers()) {}

    /// The best plan of up to so many levels with spacings no finer than number `finest`, counted from the coarsest.
    EvaluationPlan best(const Layer& layer, int finest, int levels) const {
        EvaluationPlan best_plan{{}, layer.points * centers_};
        if (levels == 0) return best_plan;
        for (int s = coarsest_; s <= finest; ++s) {
            const double spacing = kCoarsestSpacing / std::pow(kSpacingRatio, s);
            const double near = kGatheredPerNear * neighbours_.within(FarField::kRadius * spacing);
            const Layer nodes = nodes_about(layer, spacing);
            double cost = layer.points * (kNearCost * near + kPointCost) +
                          layer.visits * cells_about(layer, spacing) * (kGatherCost * near + kCellCost) +
                          nodes.points * (kNearCost * near + kNodeCost);
            if (cost >= best_plan.cost) continue;
            const EvaluationPlan rest = best(nodes, s - 1, levels - 1);
            cost += rest.cost;
            if (cost >= best_plan.cost) continue;
            best_plan = {rest.spacings, cost};
            best_plan.spacings.insert(best_plan.spacings.begin(), spacing);
        }
        return best_plan;
    }

private:
    double volume(double thickness) const { return area_ * thickness + std::pow(thickness, 3); }
    Layer nodes_about(const Layer& layer, double spacing) const {
        const double thickness = layer.thickness + kStencilLayers * spacing;
        return {volume(thickness) / std::pow(spacing, 3), thickness, 1};
    }
    double cells_about(const Layer& layer, double spacing) const {
        return std::min(layer.points, volume(layer.thickness + 2 * spacing) / std::pow(spacing, 3));
    }

    int coarsest_;  ///< the number of the coarsest spacing
    double centers_, area_;
    NeighbourCounts neighbours_;
};

}  // namespace

EvaluationPlan plan_evaluation(const ImplicitFunction& function, double points, double coarsest_spacing) {
    const double direct = points * static_cast<double>(function.centers().size());
    if (!(direct > 1e6)) return {{}, direct};
    return Planner(function, coarsest_spacing).best({points, 0, kVisitsPerCell}, kSpacings - 1, kMostLevels);
}

}  // namespace kontur
