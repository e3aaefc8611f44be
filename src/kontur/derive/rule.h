// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/derive/margin.h"

namespace kontur {

enum class Operation { name, body, join, meet, without, margin, margin_along, fill, largest, drop, clip };

/// What a rule says on the right of its '=', or a part of that.
struct Expression {
    Operation operation = Operation::name;
    std::size_t place = 0;  ///< of its first byte in the rule
    std::vector<Expression> operands{};
    std::string name{};                      ///< of a structure
    SideLengths lengths{};                   ///< of a margin
    MarginSide side = MarginSide::outwards;  ///< of a margin
    Vec3 way{};                              ///< of a margin along a direction, mm
    Plane plane{};                           ///< of a clip, which keeps what lies on the side of its normal
    double least_ml = 0;                     ///< of parts that stay
    std::optional<double> threshold{};       ///< of the body's outline, in the image's values
};

/// "NAME = EXPRESSION" (docs/derive.md has the grammar).
struct Rule {
    std::string text;
    std::string name;
    std::size_t name_place = 0;
    Expression expression;
};

/// Throws Error(invalid_input), with a mark at the place, for what is no rule.
Rule read_rule(const std::string& text);

/// A structure that an expression names.
struct NamedPlace {
    std::string name;
    std::size_t place;
};
/// In their order in the rule; what is named twice stands there twice.
std::vector<NamedPlace> names_in(const Expression& expression);

/// Whether a rule asks for the outline of the body in the image.
bool needs_image(const Expression& expression);

}  // namespace kontur
