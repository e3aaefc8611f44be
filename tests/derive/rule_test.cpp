// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/rule.h"

#include <gtest/gtest.h>

#include "kontur/base/error.h"
#include "kontur/derive/derive.h"

namespace kontur {
namespace {

std::string sentence_of(const std::string& rule) {
    try {
        read_rule(rule);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        return error.what();
    }
    return "";
}

/// The expression with all its brackets.
std::string text_of(const Expression& e) {
    const auto part = [&](std::size_t n) { return text_of(e.operands[n]); };
    const std::string sign = e.side == MarginSide::outwards ? "+" : "-";
    switch (e.operation) {
        case Operation::name:
            return e.name;
        case Operation::body:
            return "body";
        case Operation::join:
            return "(" + part(0) + "|" + part(1) + ")";
        case Operation::meet:
            return "(" + part(0) + "&" + part(1) + ")";
        case Operation::without:
            return "(" + part(0) + "-" + part(1) + ")";
        case Operation::margin:
            return "(" + part(0) + sign + std::to_string(static_cast<int>(e.lengths.largest())) + ")";
        case Operation::margin_along:
            return "(" + part(0) + sign + "way)";
        case Operation::fill:
            return "fill" + part(0);
        case Operation::largest:
            return "largest" + part(0);
        case Operation::drop:
            return "drop" + part(0);
        case Operation::clip:
            return "clip" + part(0);
    }
    return "?";
}

TEST(Rule, IsReadFromTheLeftWithIntersectionsFirst) {
    const auto read = [](const std::string& right) { return text_of(read_rule("X = " + right).expression); };
    EXPECT_EQ(read("CTV + 5 mm"), "(CTV+5)");
    EXPECT_EQ(read("PTV - (Cord + 3 mm)"), "(PTV-(Cord+3))");
    EXPECT_EQ(read("PTV + 30 mm - (PTV + 5 mm)"), "((PTV+30)-(PTV+5))");
    EXPECT_EQ(read("PTV - Cord + 3 mm"), "((PTV-Cord)+3)");
    EXPECT_EQ(read("A | B & C"), "(A|(B&C))");
    EXPECT_EQ(read("A or B and C - D"), "((A|(B&C))-D)");
    EXPECT_EQ(read("A + B"), "(A|B)");
    EXPECT_EQ(read("'Lung L' | \"or\""), "(Lung L|or)");
    EXPECT_EQ(read("A - 0.4cm"), "(A-4)");
    EXPECT_EQ(read("crop(A, Body, 3 mm)"), "(A&(Body-3))");
    EXPECT_EQ(read("avoid(A, B, 2 mm)"), "(A-(B+2))");
    EXPECT_EQ(read("crop(A, body())"), "(A&body)");
    EXPECT_EQ(read("fill(largest(drop(A, 0.5 ml)))"), "filllargestdropA");
    EXPECT_EQ(read("A + 10 mm along (0, 0, -2)"), "(A+way)");
    EXPECT_EQ(read("clip(A, superior -12.5 mm)"), "clipA");
}

TEST(Rule, GivesEachSideItsLength) {
    const SideLengths one = read_rule("X = A + {4 mm, posterior 1 cm, left 0 mm}").expression.lengths;
    EXPECT_EQ(one.left, 0);
    EXPECT_EQ(one.right, 4);
    EXPECT_EQ(one.posterior, 10);
    EXPECT_EQ(one.superior, 4);
    const SideLengths two = read_rule("X = A - {inferior 3 mm}").expression.lengths;
    EXPECT_EQ(two.inferior, 3);
    EXPECT_EQ(two.anterior, 0);
    const Vec3 way = read_rule("X = A + 10 mm along anterior").expression.way;
    EXPECT_EQ(way, (Vec3{0, -10, 0}));
}

TEST(Rule, SaysAtWhichPlaceItIsWrong) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"PTV = CTV + 5", "`PTV = CTV + 5^`, column 14: 'mm' is missing here; a length has its unit behind it"},
        {"PTV = CTV + 5 mn", "`PTV = CTV + 5 ^mn`, column 15: 'mm' is missing"},
        {"PTV CTV", "`PTV ^CTV`, column 5: '=' is missing here"},
        {"PTV = (CTV + 5 mm", "`PTV = (CTV + 5 mm^`, column 18: ')' is missing here"},
        {"PTV = CTV + -5 mm", "`PTV = CTV + ^-5 mm`, column 13: a length cannot be below 0"},
        {"PTV = CTV 5 mm", "`PTV = CTV ^5 mm`, column 11: the rule should end before '5'"},
        {"PTV = grow(CTV)", "`PTV = ^grow(CTV)`, column 7: there is no function 'grow'; there are crop"},
        {"PTV = CTV + {lef 3 mm}", "`PTV = CTV + {^lef 3 mm}`, column 14: left, right"},
        {"PTV = CTV + {left 3 mm, left 4 mm}", "column 25: a second length"},
        {"PTV = CTV * 2", "column 11: '*' has no meaning here"},
        {"PTV = 'CTV", "column 7: the quotes of this name are not closed"},
        {"PTV = CTV + 2000 mm", "column 13: the length is 2000 mm, but must be at most 1000 mm"},
        {"PTV = A + 3 mm along (0, 0, 0)", "column 22: this direction has no length"},
        {"Größe = Ä + 5", "column 14: 'mm' is missing"},
        {"PTV = ", "column 7: a structure is missing here"},
        {"", "column 1: here is no rule"},
        {"PTV = 5 mm", "column 7: a structure is missing here"},
        {"PTV = drop(A, 3 mm)", "column 17: 'ml' is missing"},
    };
    for (const auto& [rule, sentence] : cases)
        EXPECT_NE(sentence_of(rule).find(sentence), std::string::npos) << sentence_of(rule);
}

TEST(Rule, OfAnyBytesIsReadOrRefused) {
    const std::string rule = "PTV = crop(CTV + {4 mm, left 1 cm} & 'A b', body(-200), 3 mm) - 2 mm along (0, 1, -.5)";
    for (std::size_t end = 0; end < rule.size(); ++end)
        for (const char c : {'\0', '(', '{', '\'', '9', ',', '\xC3'}) {
            std::string changed = rule;
            changed[end] = c;
            for (const std::string& one : {changed, rule.substr(0, end)}) {
                try {
                    read_rule(one);
                } catch (const Error& error) {
                    EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
                }
            }
        }
    EXPECT_NE(sentence_of("X = " + std::string(3000, '(')).find("more than 100 times"), std::string::npos);
    EXPECT_NE(sentence_of("X = " + std::string(5000, 'A')).find("5004 bytes; 4000 are possible"), std::string::npos);
}

TEST(Rule, OfACircleNamesItsMembers) {
    const std::vector<std::string> rules{"A = B + 1 mm", "B = C | S", "C = A - 2 mm"};
    try {
        check_rules(rules, std::vector<std::string>{"S"}, false);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()),
                  "rule `C = ^A - 2 mm`, column 5: rules run in a circle: A needs B needs C needs A; one of them has to be "
                  "without");
    }
    EXPECT_THROW(check_rules(std::vector<std::string>{"A = A + 1 mm"}, {}, false), Error);
}

TEST(Rule, NamesWhatIsNotThere) {
    const std::vector<std::string> structures{"CTV", "Cord"};
    const auto sentence = [&](const std::vector<std::string>& rules) {
        try {
            check_rules(rules, structures, false);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(sentence({"PTV = CTW + 5 mm"}),
              "rule `PTV = ^CTW + 5 mm`, column 7: there is no structure 'CTW'; there are CTV, Cord, PTV");
    EXPECT_NE(sentence({"CTV = Cord + 5 mm"}).find("`^CTV = Cord + 5 mm`, column 1: 'CTV' is there"), std::string::npos);
    EXPECT_NE(sentence({"P = CTV", "P = Cord"}).find("a second rule makes 'P'"), std::string::npos);
    EXPECT_NE(sentence({"P = CTV & body()"}).find("and none is given"), std::string::npos);
    EXPECT_EQ(sentence({"Q = P - Cord", "P = CTV + 5 mm"}), "");
    EXPECT_EQ(sources_of(std::vector<std::string>{"Q = P - Cord", "P = CTV + 5 mm - Cord"}),
              (std::vector<std::string>{"Cord", "CTV"}));
}

}  // namespace
}  // namespace kontur
