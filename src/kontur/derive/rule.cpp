// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/rule.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "kontur/derive/rule_words.h"

namespace kontur {
namespace {

constexpr double kMostMm = 1000;  ///< longer than a patient is thick
constexpr int kMostDepth = 100;

/// A direction of the patient, and how a length along it is named among SideLengths.
struct Direction {
    std::string_view word;
    double SideLengths::*length;
    Vec3 towards;
};
constexpr std::array kDirections{
    Direction{"left", &SideLengths::left, {1, 0, 0}},          Direction{"right", &SideLengths::right, {-1, 0, 0}},
    Direction{"anterior", &SideLengths::anterior, {0, -1, 0}}, Direction{"posterior", &SideLengths::posterior, {0, 1, 0}},
    Direction{"superior", &SideLengths::superior, {0, 0, 1}},  Direction{"inferior", &SideLengths::inferior, {0, 0, -1}},
};
constexpr std::string_view kDirectionWords = "left, right, anterior, posterior, superior or inferior";

const Direction* direction_of(const RuleWord& word) {
    if (word.kind != WordKind::name) return nullptr;
    for (const Direction& one : kDirections)
        if (one.word == word.text) return &one;
    return nullptr;
}

SideLengths everywhere(double length) { return {length, length, length, length, length, length}; }

Expression with_operands(Operation operation, Expression a, Expression b) {
    Expression expression{.operation = operation, .place = a.place};
    expression.operands.push_back(std::move(a));
    expression.operands.push_back(std::move(b));
    return expression;
}

Expression with_operand(Operation operation, Expression a) {
    Expression expression{.operation = operation, .place = a.place};
    expression.operands.push_back(std::move(a));
    return expression;
}

/// A gap of 0 moves nothing.
Expression with_gap(Expression structure, double gap, MarginSide side) {
    if (gap == 0) return structure;
    Expression expression = with_operand(Operation::margin, std::move(structure));
    expression.lengths = everywhere(gap);
    expression.side = side;
    return expression;
}

/// Reads by descent, one function for each line of the grammar.
class Parser {
public:
    explicit Parser(const std::string& text) : text_(text), words_(words_of(text)) {}

    Rule rule() {
        Rule rule{text_, "", word().place, {}};
        if (word().kind == WordKind::end) refuse("here is no rule; write NAME = STRUCTURE + 5 mm, say");
        rule.name = name("the name of the structure to make");
        expect("=", "a rule is NAME = EXPRESSION");
        rule.expression = sum();
        if (word().kind != WordKind::end)
            refuse(fmt::format("the rule should end before '{}', or +, -, | or & come", word().text));
        return rule;
    }

private:
    const RuleWord& word(std::size_t ahead = 0) const { return words_[std::min(at_ + ahead, words_.size() - 1)]; }
    bool is(std::string_view text, std::size_t ahead = 0) const {
        const RuleWord& one = word(ahead);
        return (one.kind == WordKind::sign || one.kind == WordKind::name) && one.text == text;
    }
    bool take(std::string_view text) {
        if (!is(text)) return false;
        ++at_;
        return true;
    }
    void expect(std::string_view text, std::string_view why) {
        if (!take(text)) refuse(fmt::format("'{}' is missing here; {}", text, why));
    }
    [[noreturn]] void refuse(const std::string& sentence) const { refuse_rule(text_, word().place, sentence); }

    std::string name(std::string_view what) {
        if (word().kind != WordKind::name && word().kind != WordKind::quoted_name)
            refuse(fmt::format("{} is missing here", what));
        return words_[at_++].text;
    }

    /// sum = product { ("|" | "or" | "+" | "-") product | ("+" | "-") margin }
    Expression sum() {
        if (++depth_ > kMostDepth) refuse(fmt::format("brackets lie in each other more than {} times", kMostDepth));
        Expression expression = product();
        while (true) {
            const bool adds = is("+"), takes = is("-");
            if ((adds || takes) && (word(1).kind == WordKind::number || is("{", 1) || is("-", 1))) {
                ++at_;
                expression = with_margin(std::move(expression), adds ? MarginSide::outwards : MarginSide::inwards);
            } else if (take("|") || take("or") || take("+")) {
                expression = with_operands(Operation::join, std::move(expression), product());
            } else if (take("-")) {
                expression = with_operands(Operation::without, std::move(expression), product());
            } else {
                --depth_;
                return expression;
            }
        }
    }

    /// product = operand { ("&" | "and") operand }
    Expression product() {
        Expression expression = operand();
        while (take("&") || take("and")) expression = with_operands(Operation::meet, std::move(expression), operand());
        return expression;
    }

    Expression operand() {
        const std::size_t place = word().place;
        if (take("(")) {
            Expression expression = sum();
            expect(")", "brackets that open have to close");
            return expression;
        }
        if (word().kind == WordKind::name && is("(", 1)) return call();
        if (word().kind == WordKind::number) refuse("a structure is missing here; a length stands behind + or -");
        Expression expression{.place = place};
        expression.name = name("a structure");
        return expression;
    }

    Expression call() {
        const RuleWord function = word();
        at_ += 2;
        Expression expression = arguments(function);
        expect(")", fmt::format("{}(...) ends here", function.text));
        expression.place = function.place;
        return expression;
    }

    Expression arguments(const RuleWord& function) {
        if (function.text == "body") return body();
        if (function.text == "fill") return with_operand(Operation::fill, sum());
        if (function.text == "largest") return with_operand(Operation::largest, sum());
        if (function.text == "drop") return drop();
        if (function.text == "clip") return clip();
        if (function.text == "crop" || function.text == "avoid") return beside(function.text == "crop");
        refuse_rule(text_, function.place,
                    fmt::format("there is no function '{}'; there are crop, avoid, fill, largest, drop, clip and body",
                                function.text));
    }

    Expression body() {
        Expression expression{.operation = Operation::body};
        if (is(")")) return expression;
        const bool below_0 = take("-");
        expression.threshold = number("the least value of the body, such as -250") * (below_0 ? -1 : 1);
        return expression;
    }

    Expression drop() {
        Expression expression = with_operand(Operation::drop, sum());
        expect(",", "drop(STRUCTURE, 0.5 ml) drops parts below that");
        expression.least_ml = number("a volume");
        expect("ml", "a volume has its unit behind it");
        return expression;
    }

    /// crop(A, B, gap) and avoid(A, B, gap).
    Expression beside(bool within) {
        Expression a = sum();
        expect(",",
               within ? "crop(A, B, 3 mm) keeps of A what lies in B" : "avoid(A, B, 3 mm) keeps of A what lies out of B");
        Expression b = sum();
        const double gap = take(",") ? length() : 0;
        Expression border = with_gap(std::move(b), gap, within ? MarginSide::inwards : MarginSide::outwards);
        return with_operands(within ? Operation::meet : Operation::without, std::move(a), std::move(border));
    }

    Expression clip() {
        Expression expression = with_operand(Operation::clip, sum());
        expect(",",
               "clip(A, superior 120 mm) keeps what lies superior of z = 120 mm, clip(A, (0, 0, 120), (0, 0, 1)) as well");
        if (const Direction* towards = direction_of(word())) {
            ++at_;
            const bool below_0 = take("-");
            const double place = length() * (below_0 ? -1 : 1);
            const Vec3 along{std::abs(towards->towards.x), std::abs(towards->towards.y), std::abs(towards->towards.z)};
            expression.plane = make_plane(place * along, towards->towards);
            return expression;
        }
        if (!is("(")) refuse(fmt::format("{} is missing here, or a point (x, y, z)", kDirectionWords));
        const Vec3 origin = vector();
        expect(",", "behind the point comes the direction of what stays, (x, y, z)");
        expression.plane = make_plane(origin, direction());
        return expression;
    }

    /// margin = length | length "along" direction | "{" part { "," part } "}", where part = [ side ] length
    Expression with_margin(Expression structure, MarginSide side) {
        if (is("-")) refuse("a length cannot be below 0; '-' before it moves the surface inwards");
        Expression expression = with_operand(Operation::margin, std::move(structure));
        expression.side = side;
        if (take("{")) {
            expression.lengths = side_lengths();
            return expression;
        }
        const double by = length();
        expression.lengths = everywhere(by);
        if (!take("along")) return expression;
        expression.operation = Operation::margin_along;
        expression.way = by * direction();
        return expression;
    }

    SideLengths side_lengths() {
        SideLengths lengths;
        std::array<bool, 6> is_named{};
        std::optional<double> others;
        do {
            const Direction* one = direction_of(word());
            if (!one && word().kind != WordKind::number)
                refuse(fmt::format("{} is missing here, or a length for all other directions", kDirectionWords));
            bool& named = is_named[one ? static_cast<std::size_t>(one - kDirections.data()) : 0];
            if (one ? named : others.has_value()) refuse("a second length for this direction");
            if (one) {
                ++at_;
                named = true;
                lengths.*(one->length) = length();
            } else {
                others = length();
            }
        } while (take(","));
        expect("}", "lengths for single directions end with it, and ',' parts them");
        for (std::size_t n = 0; n < kDirections.size(); ++n)
            if (!is_named[n]) lengths.*(kDirections[n].length) = others.value_or(0);
        return lengths;
    }

    double number(std::string_view what) {
        if (word().kind != WordKind::number) refuse(fmt::format("{} is missing here", what));
        return words_[at_++].number;
    }

    /// In mm.
    double length() {
        const std::size_t place = word().place;
        double mm = number("a length such as 5 mm");
        if (take("cm")) mm *= 10;
        else expect("mm", "a length has its unit behind it, mm or cm");
        if (mm > kMostMm)
            refuse_rule(text_, place, fmt::format("the length is {:g} mm, but must be at most {:g} mm", mm, kMostMm));
        return mm;
    }

    Vec3 vector() {
        Vec3 found;
        expect("(", "a vector is (x, y, z), in mm and LPS");
        for (int axis = 0; axis < 3; ++axis) {
            if (axis > 0) expect(",", "a vector is (x, y, z)");
            const bool below_0 = take("-");
            found[axis] = number("a coordinate") * (below_0 ? -1 : 1);
        }
        expect(")", "a vector is (x, y, z)");
        return found;
    }

    /// Of length 1.
    Vec3 direction() {
        if (const Direction* one = direction_of(word())) {
            ++at_;
            return one->towards;
        }
        if (!is("(")) refuse(fmt::format("{} is missing here, or a direction (x, y, z)", kDirectionWords));
        const std::size_t place = word().place;
        const Vec3 found = normalized(vector());
        if (found == Vec3{}) refuse_rule(text_, place, "this direction has no length");
        return found;
    }

    const std::string& text_;
    std::vector<RuleWord> words_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

void add_names(const Expression& expression, std::vector<NamedPlace>& names) {
    if (expression.operation == Operation::name) names.push_back({expression.name, expression.place});
    for (const Expression& operand : expression.operands) add_names(operand, names);
}

}  // namespace

Rule read_rule(const std::string& text) { return Parser(text).rule(); }

std::vector<NamedPlace> names_in(const Expression& expression) {
    std::vector<NamedPlace> names;
    add_names(expression, names);
    return names;
}

bool needs_image(const Expression& expression) {
    if (expression.operation == Operation::body) return true;
    for (const Expression& operand : expression.operands)
        if (needs_image(operand)) return true;
    return false;
}

}  // namespace kontur
