// SPDX-License-Identifier: Apache-2.0
#include "archive/dicom_json.h"

#include <gtest/gtest.h>

#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

TEST(DicomJson, ValuesOfAllKinds) {
    const auto objects = json_objects(R"([{"00100010": {"vr": "PN", "Value": [{"Alphabetic": "Doe^Jane"}]},
        "00201208": {"vr": "IS", "Value": [7]}, "00201206": {"vr": "IS", "Value": ["8"]}, "00080061": {"vr": "CS", "Value": ["CT", "SEG"]},
        "00081030": {"vr": "LO"}, "00081199": {"vr": "SQ", "Value": [{"00081155": {"vr": "UI", "Value": ["1.2"]}}]}}])");
    ASSERT_EQ(objects.size(), 1u);
    const nlohmann::json& object = objects.front();
    EXPECT_EQ(value_of(object, "00100010"), "Doe^Jane");
    EXPECT_EQ(count_of(object, "00201208"), 7);
    EXPECT_EQ(count_of(object, "00201206"), 8);
    EXPECT_EQ(values_of(object, "00080061"), (std::vector<std::string>{"CT", "SEG"}));
    EXPECT_EQ(value_of(object, "00081030"), "");
    EXPECT_EQ(value_of(object, "7FE00010"), "");
    ASSERT_EQ(items_of(object, "00081199").size(), 1u);
    EXPECT_EQ(value_of(items_of(object, "00081199").front(), "00081155"), "1.2");
}

TEST(DicomJson, OddValuesAreNone) {
    const auto objects =
        json_objects(R"([{"1": 5, "2": {"Value": 5}, "3": {"Value": [null, [], {}, true]}, "4": {"Value": [-3]},
        "5": {"Value": ["a\u0007b"]}, "6": {"Value": [{"Alphabetic": 3}]}}])");
    for (const char* tag : {"1", "2", "3", "6"}) EXPECT_EQ(value_of(objects.front(), tag), "") << tag;
    EXPECT_EQ(count_of(objects.front(), "4"), 0);
    EXPECT_EQ(value_of(objects.front(), "5"), "a?b");
    EXPECT_TRUE(items_of(objects.front(), "5").empty());
}

TEST(DicomJson, WhatIsNoListOfObjectsIsRefused) {
    EXPECT_TRUE(json_objects("").empty());
    EXPECT_TRUE(json_objects("[]").empty());
    EXPECT_EQ(json_objects("{}").size(), 1u);
    for (const char* text : {"<html>", "[1]", "5", "[{]", "[{\"a\": 1, \"a\": 2}]"})
        EXPECT_THROW(json_objects(text), Error) << text;
    EXPECT_THROW(json_objects(std::string(100'000, '[')), Error);
}

}  // namespace
}  // namespace kontur::archive
