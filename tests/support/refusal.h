// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "kontur/base/error.h"

namespace kontur::test {

/// The message with which a reader refuses a file: an Error of this kind that begins with the file's name.
inline std::string refusal_of(const std::filesystem::path& file, ErrorKind kind, const std::function<void()>& read) {
    try {
        read();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), kind) << error.what();
        EXPECT_TRUE(std::string_view(error.what()).starts_with(file.string())) << error.what();
        return error.what();
    }
    ADD_FAILURE() << file << " was accepted";
    return {};
}

}  // namespace kontur::test
