// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

// Whether messages of a page are what the protocol says (apps/viewer/protocol, of which the tables are made).

namespace kontur::viewer {

/// What a value in a message may be.
struct Type {
    enum Kind { any, null, boolean, number, integer, text, list, object, either };
    struct Member {
        std::string_view name;
        const Type* type;
        bool is_needed;
    };

    Kind kind = any;
    std::string_view needed = {};  ///< the same in words
    double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
    bool is_above_least = false;  ///< the least one is not allowed itself
    const char* pattern = nullptr;
    std::vector<std::string_view> words = {};
    const Type* items = nullptr;
    std::vector<Member> members = {};
    std::vector<const Type*> choices = {};
};

using Types = std::map<std::string, const Type*, std::less<>>;
/// Of the calls' arguments, by the calls' names; and of requests' bodies.
const Types& call_types();
const Types& request_types();

/// Throws Error(invalid_input), a sentence that names the member, its value and what is needed, where the message is not of
/// the type. A misspelt argument is refused, too; a message may have `beside` the arguments.
void check_message(const nlohmann::json& message, const Type& type, const std::vector<std::string_view>& beside = {});

/// The body of a request, whose type is named.
nlohmann::json parsed_request(std::string_view body, std::string_view type);

}  // namespace kontur::viewer
