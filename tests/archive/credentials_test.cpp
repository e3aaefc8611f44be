// SPDX-License-Identifier: Apache-2.0
#include "archive/credentials.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "archive/address.h"
#include "archive/http.h"
#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

namespace fs = std::filesystem;

class CredentialsFile : public testing::Test {
protected:
    void SetUp() override { ::unsetenv(kCredentialsVariable); }
    void TearDown() override { fs::remove(file_); }

    Credentials read(const std::string& content, fs::perms mode = fs::perms::owner_read | fs::perms::owner_write) {
        std::ofstream(file_, std::ios::binary) << content;
        fs::permissions(file_, mode);
        return read_credentials(file_);
    }

    fs::path file_ = fs::path(testing::TempDir()) / ("kontur-credentials-" + std::to_string(::getpid()));
};

TEST_F(CredentialsFile, HoldsAUserAndAPasswordThatMayHaveColons) {
    const Credentials credentials = read("me:pass:word \n");
    EXPECT_EQ(credentials.user, "me");
    EXPECT_EQ(credentials.password, "pass:word ");
    EXPECT_TRUE(credentials.token.empty());
}

TEST_F(CredentialsFile, OrAToken) {
    const Credentials credentials = read("Bearer ab.c:d\r\n");
    EXPECT_EQ(credentials.token, "ab.c:d");
    EXPECT_TRUE(credentials.user.empty());
}

TEST_F(CredentialsFile, IsRefusedWithoutQuotingIt) {
    for (const char* content : {"", "\n", "secret", "me:secret\nHeader: secret", "Bearer ", ":secret", "Bearer sec\x01ret"})
        try {
            read(content);
            FAIL() << content;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
            EXPECT_EQ(std::string(error.what()).find("sec"), std::string::npos) << error.what();
        }
}

TEST_F(CredentialsFile, IsForItsOwnerAlone) {
    EXPECT_THROW(read("me:word", fs::perms::owner_read | fs::perms::group_read), Error);
    EXPECT_THROW(read_credentials("/no/such/file"), Error);
    EXPECT_THROW(read_credentials(testing::TempDir()), Error);
}

TEST_F(CredentialsFile, MayBeAVariableInstead) {
    EXPECT_TRUE(read_credentials("").is_empty());
    ::setenv(kCredentialsVariable, "me:word", 1);
    EXPECT_EQ(read_credentials("").user, "me");
    EXPECT_EQ(read_credentials("").origin, kCredentialsVariable);
}

TEST(Http, TakesNoCredentialsOverAnOpenNetwork) {
    Access access;
    access.credentials = {"me", "secret", "", "--credentials FILE"};
    EXPECT_THROW(Http(parse_address("http://archive.example/dicom-web"), access), Error);
    EXPECT_NO_THROW(Http(parse_address("https://archive.example/dicom-web"), access));
    EXPECT_NO_THROW(Http(parse_address("http://127.0.0.1:8042/dicom-web"), access));
}

}  // namespace
}  // namespace kontur::archive
