// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: JPEG 2000, which DCMTK does not decode.

#include <cstdint>
#include <span>
#include <vector>

namespace kontur {

/// The samples of a grey-scale image, row after row, from a code stream or a JP2 file. Throws Error(corrupt_file) when it is
/// damaged or has another size than said, and Error(unsupported) for colour. Nothing is allocated for an image before its
/// size was compared.
std::vector<std::int32_t> decode_jpeg2000(std::span<const std::uint8_t> code, std::int64_t columns, std::int64_t rows);

}  // namespace kontur
