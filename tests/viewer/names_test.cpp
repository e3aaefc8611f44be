// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/names.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "viewer/model/file_names.h"
#include "viewer/model/stage_words.h"

namespace kontur::viewer {
namespace {

TEST(Names, LettersOfAnyScriptAreTakenAndControlCharactersAndDirectionMarksAreNot) {
    for (const char* name : {"", "Liver", "Leber, groß", "\u809d\u810f", "\u05db\u05d1\u05d3", "GTV \U0001F3AF"}) {
        EXPECT_NO_THROW(check_name(name)) << name;
        EXPECT_EQ(plain_text(name), name);
    }
    for (const char* name :
         {"Li\nver", "Li\tver", "Li\x7fver", "Li\u0085ver", "Li\u202ever", "Li\u200fver", "Li\u2066ver", "Li\u2028ver"}) {
        EXPECT_THROW(check_name(name), Error) << name;
        EXPECT_EQ(plain_text(name), "Liver");
    }
}

TEST(Names, TheRefusalNamesTheCharacter) {
    try {
        check_name("evil\u202egnp");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("U+202E"), std::string::npos) << error.what();
    }
}

TEST(FileNames, OtherCharactersBecomeOneLine) {
    EXPECT_EQ(plain_name("Doe, Jane  Thorax 2.5"), "Doe_Jane_Thorax_2_5");
    EXPECT_EQ(plain_name(""), "structure");
}

TEST(StageWords, NoWordOfTheMethodReachesTheStatusLine) {
    for (const char* stage : {"solve", "voxelize", "polygonize"}) EXPECT_NE(words_of_stage(stage), stage);
    EXPECT_EQ(words_of_stage("phantom"), "phantom");
}

}  // namespace
}  // namespace kontur::viewer
