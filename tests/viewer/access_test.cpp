// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/access.h"

#include <gtest/gtest.h>

#include <set>

namespace kontur::viewer {
namespace {

const Access kAccess{8420, "secret"};

RequestHead get(const std::string& target) {
    return {"GET", parse_target(target), {"127.0.0.1:8420"}, {}, {"Bearer secret"}, {}, false};
}

RequestHead upgrade() {
    return {"GET", parse_target("/api/socket"), {"localhost:8420"}, {"http://localhost:8420"}, {}, {"kontur, secret"}, true};
}

int status(const RequestHead& head) {
    const auto refused = refusal(head, kAccess);
    return refused ? refused->status : 200;
}

TEST(Access, AdmitsThePageOnEachLoopbackName) {
    for (const char* host : {"127.0.0.1:8420", "localhost:8420", "[::1]:8420"}) {
        RequestHead head = get("/api/mesh/1");
        head.host = {host};
        EXPECT_EQ(status(head), 200) << host;
        head.origin = {std::string("http://") + host};
        EXPECT_EQ(status(head), 200) << host;
    }
    EXPECT_EQ(status(upgrade()), 200);
}

TEST(Access, ThePagesFilesNeedNoTokenButTheRightHost) {
    RequestHead head = get("/index.html");
    head.authorization.clear();
    EXPECT_EQ(status(head), 200);
    head.host = {"kontur.example:8420"};
    EXPECT_EQ(status(head), 421);
}

TEST(Access, NoSpellingOfAnApiAddressGoesWithoutTheToken) {
    for (const char* target :
         {"/api/mesh/1", "/%61pi/mesh/1", "/a%70i/mesh/1", "/api%2fmesh/1", "%2fapi/mesh/1", "/api/%zz"}) {
        RequestHead head = get(target);
        head.authorization.clear();
        EXPECT_EQ(status(head), 401) << target;
    }
}

TEST(Access, ChecksHostBeforeOriginBeforeTokenBeforeMethod) {
    RequestHead head{"DELETE", parse_target("/api/x"), {"evil:8420"}, {"http://evil"}, {}, {}, false};
    EXPECT_EQ(status(head), 421);
    head.host = {"127.0.0.1:8420"};
    EXPECT_EQ(status(head), 403);
    head.origin.clear();
    EXPECT_EQ(status(head), 401);
    head.authorization = {"Bearer secret"};
    EXPECT_EQ(status(head), 405);
}

TEST(Access, ASocketNeedsOriginAndToken) {
    RequestHead head = upgrade();
    head.origin.clear();
    EXPECT_EQ(status(head), 403);
    head.origin = {"null"};
    EXPECT_EQ(status(head), 403);
    head = upgrade();
    head.protocols = {"kontur"};
    EXPECT_EQ(status(head), 401);
    head.protocols.clear();
    head.authorization = {"Bearer secret"};
    EXPECT_EQ(status(head), 401);
}

TEST(Access, TokensAreLongAndDiffer) {
    std::set<std::string> tokens;
    for (int i = 0; i < 100; ++i) tokens.insert(random_token());
    EXPECT_EQ(tokens.size(), 100u);
    EXPECT_EQ(tokens.begin()->size(), 32u);
}

TEST(ParseTarget, DecodesPathAndQuery) {
    const auto target = parse_target("/a%20b/c?name=x%2Fy&flag&n=1=2");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/a b/c");
    EXPECT_EQ(target->parameter("name"), "x/y");
    EXPECT_EQ(target->parameter("flag"), "");
    EXPECT_EQ(target->parameter("n"), "1=2");
    EXPECT_EQ(target->parameter("none"), std::nullopt);
}

TEST(ParseTarget, HasSpacesInQueriesAsFormsWriteThem) {
    const auto target = parse_target("/a+b?path=/my+scans%20%2B+old");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/a+b");
    EXPECT_EQ(target->parameter("path"), "/my scans + old");
}

TEST(ParseTarget, RefusesWhatIsNoPath) {
    for (const char* target : {"", "a", "http://127.0.0.1/", "*", "/%", "/%4", "/%gg", "/?a=%f"})
        EXPECT_FALSE(parse_target(target)) << target;
}

}  // namespace
}  // namespace kontur::viewer
