// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/binary_reply.h"

#include <bit>

#include "viewer/model/model_json.h"

namespace kontur::viewer {

static_assert(std::endian::native == std::endian::little, "arrays are sent as they lie in memory");

std::string BinaryReply::bytes() const {
    std::string head = to_text(head_);
    head.append((4 - head.size() % 4) % 4, ' ');
    std::string bytes;
    bytes.reserve(4 + head.size() + arrays_.size());
    const auto length = static_cast<std::uint32_t>(head.size());
    bytes.append(reinterpret_cast<const char*>(&length), sizeof length);
    return bytes.append(head).append(arrays_);
}

}  // namespace kontur::viewer
