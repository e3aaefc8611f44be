// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kontur::viewer {

/// Compressed for a reply with `Content-Encoding: gzip`, as quickly as zlib can.
std::string gzipped(std::string_view bytes);

}  // namespace kontur::viewer
