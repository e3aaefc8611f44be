// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/message_checks.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/expect_error.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

const json kPlane{{"origin", {0, 0, 0}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}, {"mm_per_pixel", 0.5}};

const json kWithout(json::value_t::discarded);

json path_call() { return {{"plane", kPlane}, {"control", json::array({{{"at", {1, 2, 3}}, {"kind", "wire"}}})}}; }

json slice() {
    return {{"plane", kPlane}, {"width", 8}, {"height", 8}, {"window", {{"center", 0}, {"width", 1}}}, {"pixels", true}};
}

void expect_refused(const json& message, const Type& type, const std::string& sentence) {
    try {
        check_message(message, type, {"seq", "call"});
        ADD_FAILURE() << message.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 200) << " passes";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
        EXPECT_EQ(std::string(error.what()), sentence);
    }
}

/// The message with the value at the pointer in place of what it has there; discarded: without it.
json with(json message, const char* pointer, const json& value) {
    const json::json_pointer at(pointer);
    if (value.is_discarded()) message[at.parent_pointer()].erase(at.back());
    else message[at] = value;
    return message;
}

TEST(MessageChecks, EachWrongArgumentOfACallHasItsSentence) {
    const Type& path = *call_types().at("path");
    EXPECT_NO_THROW(check_message(path_call(), path));
    json far(std::vector<int>(10'001, 1));
    for (const auto& [pointer, value, sentence] : std::vector<std::tuple<const char*, json, const char*>>{
             {"/plane", kWithout, "'plane' is missing; an object is needed"},
             {"/plane/u", kWithout, "'plane.u' is missing; a point [x, y, z] is needed"},
             {"/plane", 7, "'plane' is 7; an object is needed"},
             {"/plane/origin", {0, 0}, "'plane.origin' is a list of 2; a point [x, y, z] is needed"},
             {"/plane/origin/2", 2e6, "'plane.origin[2]' is 2000000.0; a number from -1000000 to 1000000 is needed"},
             {"/plane/mm_per_pixel", 0, "'plane.mm_per_pixel' is 0; a number from 0.0001 to 10000 is needed"},
             {"/control", json::array(), "'control' is a list of 0; a list of 1 to 10000 items is needed"},
             {"/control", far, "'control' is a list of 10001; a list of 1 to 10000 items is needed"},
             {"/control/0", 1, "'control[0]' is 1; an object is needed"},
             {"/control/0/at/1", "x", "'control[0].at[1]' is \"x\"; a number from -1000000 to 1000000 is needed"},
             {"/control/0/kind", "curve", "'control[0].kind' is \"curve\"; free, line, spline or wire is needed"},
             {"/control/0/image", 16, "'control[0].image' is 16; a whole number from 0 to 15 is needed"},
             {"/control/0/image", 0.5, "'control[0].image' is 0.5; a whole number from 0 to 15 is needed"},
             {"/closed", 1, "'closed' is 1; true or false is needed"},
             {"/close", true, "'close' is not known here"},
         })
        expect_refused(with(path_call(), pointer, value), path, sentence);
    expect_refused(json::array(), path, "the message is no JSON object");
}

TEST(MessageChecks, TextsAndNumbersHaveTheirLimits) {
    const Type& set = *call_types().at("structure.set");
    const auto change = [](const char* key, const json& value) {
        json message{{"id", 1}};
        message[key] = value;
        return message;
    };
    std::string name;
    for (int i = 0; i < 100; ++i) name += "\xc3\xa4";
    EXPECT_NO_THROW(check_message(change("name", name), set)) << "100 characters, however many bytes";
    expect_refused(change("name", name + "x"), set,
                   "'name' is a text of 101 characters; a text of at most 100 characters is needed");
    expect_refused(change("color", "red"), set, "'color' is \"red\"; a colour like #e8b04a is needed");
    for (const json& right : {json(0), json(1), json(0.25), json("usual")})
        EXPECT_NO_THROW(check_message(change("smoothing", right), set));
    expect_refused(change("smoothing", 1.5), set, "'smoothing' is 1.5; a number from 0 to 1 or usual is needed");
    expect_refused(change("id", 0), set, "'id' is 0; a whole number from 1 to 9007199254740992 is needed");
    expect_refused(change("id", std::uint64_t(-1)), set,
                   "'id' is 18446744073709551615; a whole number from 1 to 9007199254740992 is needed");
    expect_refused(change("visible", nullptr), set, "'visible' is null; true or false is needed");
}

TEST(MessageChecks, EachWrongMemberOfARequestHasItsSentence) {
    EXPECT_EQ(parsed_request(slice().dump(), "SliceRequest"), slice());
    const Type& type = *request_types().at("SliceRequest");
    expect_refused(with(slice(), "/width", 4097), type, "'width' is 4097; a whole number from 1 to 4096 is needed");
    expect_refused(with(slice(), "/time", -1), type, "'time' is -1; a whole number from 0 to 99999 is needed");
    expect_refused(with(slice(), "/window/width", 0), type, "'window.width' is 0; a number greater than 0 is needed");
    expect_refused(with(slice(), "/pixels", "some"), type,
                   "'pixels' is \"some\"; true or false or values or shades is needed");
    EXPECT_NO_THROW(check_message(with(slice(), "/pixels", "values"), type));
}

}  // namespace
}  // namespace kontur::viewer
