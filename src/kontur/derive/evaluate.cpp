// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/evaluate.h"

#include "kontur/derive/margin.h"
#include "kontur/derive/parts.h"

namespace kontur {
namespace {

/// An operand, without a copy where it is there.
class Operand {
public:
    Operand(const Expression& e, const RuleScene& scene, const Work& work) {
        if (e.operation == Operation::name) given_levels_ = &scene.levels.at(e.name);
        else own_levels_ = evaluate(e, scene, work);
    }
    operator const Levels&() const { return given_levels_ ? *given_levels_ : own_levels_; }

private:
    const Levels* given_levels_ = nullptr;
    Levels own_levels_;
};

}  // namespace

Levels evaluate(const Expression& e, const RuleScene& scene, const Work& work) {
    const Grid& grid = scene.lattice.grid;
    const auto operand = [&](std::size_t n) { return Operand(e.operands[n], scene, work); };
    switch (e.operation) {
        case Operation::name:
            return scene.levels.at(e.name);
        case Operation::body:
            return scene.body(e.threshold);
        case Operation::join:
            return join(operand(0), operand(1), work);
        case Operation::meet:
            return meet(operand(0), operand(1), work);
        case Operation::without:
            return without(operand(0), operand(1), work);
        case Operation::margin:
            return margin(operand(0), grid, e.lengths, e.side, work);
        case Operation::margin_along:
            return margin_along(operand(0), grid, e.way, e.side, work);
        case Operation::fill:
            return filled(operand(0));
        case Operation::largest:
            return largest_part(operand(0));
        case Operation::drop:
            return parts_from(operand(0), grid, e.least_ml);
        case Operation::clip:
            return kept_where(
                operand(0), grid, [&](const Vec3& p) { return e.plane.distance_to(p); }, work);
    }
    return {};
}

}  // namespace kontur
