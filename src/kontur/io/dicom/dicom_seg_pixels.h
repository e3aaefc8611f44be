// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: the pixels of a segmentation's frames, however they lie in the file. Uses DCMTK's types.

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "kontur/io/dicom/dcmtk.h"

namespace kontur {

struct SegLayout {
    int bits = 1;  ///< of a pixel: 1, 8 or 16
    std::int64_t columns = 0, rows = 0, frames = 0;

    std::size_t pixels() const { return static_cast<std::size_t>(columns * rows); }  ///< of a frame
};

/// Uncompressed, deflated (as a whole or frame by frame), run-length coded, JPEG lossless, JPEG-LS or JPEG 2000.
class SegPixels {
public:
    SegPixels() = default;
    /// Of a loaded file, to which the bytes may belong. Throws Error(corrupt_file) for less than the layout claims or
    /// damaged code, and Error(unsupported), naming it, for any other compression.
    SegPixels(DcmFileFormat& file, const std::filesystem::path& path, const SegLayout& layout);

    /// Of pixel n of a frame counted from 0.
    std::uint16_t value(std::size_t frame, std::size_t n) const {
        if (layout_.bits == 1) {
            // The lowest bit of a byte comes first (PS3.5 8.1.1).
            const std::size_t at = frame * frame_stride_ + n;
            return bytes_[at >> 3] >> (at & 7) & 1;
        }
        const std::size_t at = frame * frame_stride_ / 8 + n * (layout_.bits == 16 ? 2 : 1);
        return static_cast<std::uint16_t>(layout_.bits == 16 ? bytes_[at] | bytes_[at + 1] << 8 : bytes_[at]);
    }

private:
    void decode(DcmDataset& dataset, const dcmtk::Syntax& syntax) const;
    void take_plain(DcmDataset& dataset);
    void take_frames(DcmDataset& dataset, bool is_deflated);

    SegLayout layout_;
    std::size_t frame_stride_ = 0;  ///< bits from one frame to the next
    std::vector<Uint8> decoded_;
    std::span<const Uint8> bytes_;
};

}  // namespace kontur
