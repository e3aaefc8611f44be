// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/rule_names.h"

#include <gtest/gtest.h>

#include "kontur/base/error.h"
#include "kontur/derive/rule_words.h"

namespace kontur {
namespace {

TEST(RuleNames, AreWrittenAsRulesReadThem) {
    EXPECT_EQ(name_in_rules("CTV_2.b"), "CTV_2.b");
    EXPECT_EQ(name_in_rules("Lung L"), "'Lung L'");
    EXPECT_EQ(name_in_rules("2nd"), "'2nd'");
    EXPECT_EQ(name_in_rules("or"), "'or'");
    EXPECT_EQ(name_in_rules("Leber \xc3\xbc"), "'Leber \xc3\xbc'");
    EXPECT_EQ(name_in_rules("it's"), "\"it's\"");
    EXPECT_EQ(name_in_rules(""), "''");
    EXPECT_THROW(name_in_rules("'\""), Error);
    for (const char* name : {"CTV", "Lung L", "or", "it's", "+ 5 mm", "\xc3\xbc"})
        EXPECT_EQ(name_made(name_in_rules(name) + " = A"), name);
}

TEST(RuleNames, ChangeWhereTheyStandForAStructure) {
    EXPECT_EQ(with_name("PTV = CTV + 5 mm - (CTV & Cord)", "CTV", "GTV"), "PTV = GTV + 5 mm - (GTV & Cord)");
    EXPECT_EQ(with_name("PTV=CTV+5 mm", "PTV", "Plan A"), "'Plan A'=CTV+5 mm");
    EXPECT_EQ(with_name("A = 'Lung L' | \"Lung L\"", "Lung L", "Lungs"), "A = Lungs | Lungs");
    EXPECT_EQ(with_name("A = crop(left, mm, 3 mm) + {left 2 mm}", "left", "x y"), "A = crop('x y', mm, 3 mm) + {left 2 mm}")
        << "directions and functions have no other name";
    EXPECT_EQ(with_name("A = CTV2 + 5 mm", "CTV", "GTV"), "A = CTV2 + 5 mm");
}

TEST(RuleNames, AnErrorKnowsItsPlace) {
    try {
        name_made("PTV = CTV + 5");
        FAIL();
    } catch (const RuleError& error) {
        EXPECT_EQ(error.place(), 13u);
        EXPECT_EQ(error.rule(), "PTV = CTV + 5");
        EXPECT_EQ(std::string(error.what()), "rule `PTV = CTV + 5^`, column 14: " + error.sentence());
    }
}

}  // namespace
}  // namespace kontur
