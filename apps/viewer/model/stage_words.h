// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur::viewer {

/// What the library calls a stage of its work, in words for people who draw; other names as they are.
std::string_view words_of_stage(std::string_view stage) noexcept;

}  // namespace kontur::viewer
