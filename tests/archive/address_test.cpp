// SPDX-License-Identifier: Apache-2.0
#include "archive/address.h"

#include <gtest/gtest.h>

#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

TEST(Address, ComesBackAsItWasTyped) {
    for (const char* word : {"https://host/dicom-web", "http://127.0.0.1:8042/dicom-web/studies/1.2.3",
                             "https://host/a/b/studies/1.2/series/3.4", "https://h/studies/1/series/2/instances/3",
                             "https://[::1]:8042/dicom-web/studies/1"})
        EXPECT_EQ(parse_address(word).text(), word);
}

TEST(Address, KnowsServiceAndUids) {
    const Address address = parse_address("HTTPS://Host:8443/studies-of-all/studies/1.2/series/3/instances/4.5/");
    EXPECT_EQ(address.service, "https://Host:8443/studies-of-all");
    EXPECT_EQ(address.host(), "Host:8443");
    EXPECT_EQ(address.study_uid, "1.2");
    EXPECT_EQ(address.series_uid, "3");
    EXPECT_EQ(address.instance_uid, "4.5");
}

TEST(Address, OfAListIsWhatIsListed) {
    EXPECT_EQ(parse_address("https://host/dicom-web/studies").text(), "https://host/dicom-web");
    EXPECT_EQ(parse_address("https://host/dicom-web/studies/1/series/").text(), "https://host/dicom-web/studies/1");
}

TEST(Address, IsRefusedWithoutQuotingASecret) {
    for (const char* word :
         {"https://me:secret@host/dicom-web", "https://host/dicom-web?token=secret", "https://host/x#secret"})
        try {
            parse_address(word);
            FAIL() << word;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
            EXPECT_EQ(std::string(error.what()).find("secret"), std::string::npos) << error.what();
        }
}

TEST(Address, RefusesWhatIsNone) {
    for (const char* word : {"ftp://host/x", "https://", "https:///studies/1", "https://:80/x", "https://host/studies/..",
                             "https://host/studies/1/../../2", "https://host/studies/1/serie/2", "https://ho st/x",
                             "https://host/studies/1/series/2/instances/3/frames/4"})
        EXPECT_THROW(parse_address(word), Error) << word;
}

TEST(Address, OfThisMachineIsToldApartFromNamesThatBeginLikeIt) {
    for (const char* word : {"http://localhost/x", "http://127.0.0.1:8042", "http://[::1]:80/x"})
        EXPECT_TRUE(parse_address(word).is_this_machine()) << word;
    for (const char* word :
         {"http://localhost.example/x", "http://127.0.0.1.example", "http://[::11]:80/x", "http://10.0.0.1"})
        EXPECT_FALSE(parse_address(word).is_this_machine()) << word;
}

TEST(Address, IsNoPath) {
    EXPECT_TRUE(is_address("https://host"));
    EXPECT_TRUE(is_address("HTTP://host"));
    for (const char* word : {"", "https", "https:/host", "ct.nii.gz", "/https://host"})
        EXPECT_FALSE(is_address(word)) << word;
}

TEST(Uid, HasDigitsAndDots) {
    EXPECT_TRUE(is_uid("1.2.840.10008.1.1"));
    EXPECT_FALSE(is_uid(""));
    EXPECT_FALSE(is_uid(".."));
    EXPECT_FALSE(is_uid("1.2/3"));
    EXPECT_FALSE(is_uid(std::string(65, '1')));
}

}  // namespace
}  // namespace kontur::archive
