// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <type_traits>

namespace kontur::viewer {

/// A JSON object and arrays of numbers in one run of bytes, little endian (docs/viewer-protocol.md, "HTTP").
class BinaryReply {
public:
    explicit BinaryReply(nlohmann::json head) : head_(std::move(head)) { head_["arrays"] = nlohmann::json::object(); }

    template <class Number>
    void add(const char* name, std::span<const Number> numbers) {
        static_assert(std::is_same_v<Number, float> || std::is_unsigned_v<Number>);
        const char* type = std::is_same_v<Number, float> ? "f32"
                           : sizeof(Number) == 4         ? "u32"
                           : sizeof(Number) == 2         ? "u16"
                                                         : "u8";
        head_["arrays"][name] = {{"type", type}, {"offset", arrays_.size()}, {"count", numbers.size()}};
        arrays_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
        arrays_.resize((arrays_.size() + 3) / 4 * 4);
    }

    std::string bytes() const;

private:
    nlohmann::json head_;
    std::string arrays_;
};

}  // namespace kontur::viewer
