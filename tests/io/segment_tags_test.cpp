// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/segment_tags.h"

#include <gtest/gtest.h>

namespace kontur {
namespace {

const CodedConcept kStructure{"123037004", "SCT", "Anatomical Structure"};
const CodedConcept kKidney{"64033007", "SCT", "Kidney"};

TEST(SegmentTags, TermsComeBack) {
    const SegmentTerms found = terms_in_tags(tags_of_terms({.category = kStructure, .code = kKidney}));
    EXPECT_EQ(found.category, kStructure);
    EXPECT_EQ(found.code, kKidney);
    EXPECT_EQ(tags_of_terms({}), "");
    EXPECT_EQ(terms_in_tags(tags_of_terms({.code = kKidney})).code, kKidney);
}

TEST(SegmentTags, TermsAreFoundAmongOtherTags) {
    const SegmentTerms found = terms_in_tags(
        "Segmentation.Status:inprogress|TerminologyEntry:Some list~SCT^123037004^Anatomical Structure~SCT^64033007^Kidney"
        "~SCT^7771000^Left~Other list~^^~^^|More:1|");
    EXPECT_EQ(found.category, kStructure);
    EXPECT_EQ(found.code, kKidney);
}

TEST(SegmentTags, WhatIsNoTermIsNone) {
    for (const char* tags : {"", "|", "Segmentation.Status:done|", "TerminologyEntry:", "TerminologyEntry:a~b~c",
                             "TerminologyEntry:a~^^~^1^x", "TerminologyEntry:a~SCT^^x~SCT^1"}) {
        const SegmentTerms found = terms_in_tags(tags);
        EXPECT_FALSE(found.category || found.code) << tags;
    }
}

TEST(SegmentTags, WhatWouldEndATermBecomesASpace) {
    const SegmentTerms found = terms_in_tags(
        tags_of_terms({.category = CodedConcept{"1", "99X", "a|b"}, .code = CodedConcept{"2", "99X", "c~d^e"}}));
    EXPECT_EQ(found.category->meaning, "a b");
    EXPECT_EQ(found.code->meaning, "c d e");
}

TEST(SegmentTags, BytesThatAreNoUtf8CountAsLatin1) {
    EXPECT_EQ(terms_in_tags("TerminologyEntry:a~99X^1^Gef\xE4\xDF~^^").category->meaning, "Gef\xC3\xA4\xC3\x9F");
}

}  // namespace
}  // namespace kontur
