// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_seg_pixels.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <string_view>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_frames.h"
#include "kontur/io/dicom/jpeg2000.h"

namespace kontur {
namespace {

constexpr std::string_view kDeflatedFrames = "1.2.840.10008.1.2.8.1";
/// As for images: deflate and run-length coding shrink by no more than about a thousand, and a little is always allowed.
constexpr std::uint64_t kMostExpansion = 1100, kAlwaysAllowedBytes = std::uint64_t{64} << 20;

Error corrupt(const std::string& message) { return Error(ErrorKind::corrupt_file, message); }

bool is_jpeg2000(E_TransferSyntax syntax) { return syntax == EXS_JPEG2000LosslessOnly || syntax == EXS_JPEG2000; }

bool is_decoded_by_dcmtk(E_TransferSyntax syntax) {
    constexpr std::array kDecoded{EXS_JPEGProcess14, EXS_JPEGProcess14SV1, EXS_JPEGLSLossless, EXS_RLELossless};
    return std::find(kDecoded.begin(), kDecoded.end(), syntax) != kDecoded.end();
}

void check_expansion(const std::filesystem::path& path, std::uint64_t bytes) {
    const std::uint64_t held = std::filesystem::file_size(path);
    if (bytes > kAlwaysAllowedBytes && bytes / kMostExpansion > held)
        throw corrupt(fmt::format("its header claims {} bytes of pixels, the file has {} bytes", bytes, held));
}

/// A deflate stream without a head (RFC 1951) that fills `to`; what follows it is padding.
void inflate_frame(std::span<const Uint8> code, std::span<Uint8> to) {
    z_stream stream{};
    if (::inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    stream.next_in = const_cast<Uint8*>(code.data());
    stream.avail_in = static_cast<uInt>(code.size());
    stream.next_out = to.data();
    stream.avail_out = static_cast<uInt>(to.size());
    ::inflate(&stream, Z_FINISH);
    const std::size_t left = stream.avail_out;
    ::inflateEnd(&stream);
    if (left > 0) throw corrupt(fmt::format("a deflated frame ends {} bytes too early", left));
}

void put_sample(std::span<Uint8> frame, std::size_t n, int bits, std::int32_t value) {
    const auto sample = static_cast<std::uint32_t>(value);
    if (sample >> bits != 0) throw corrupt(fmt::format("a pixel has the value {}, more than {} bits hold", value, bits));
    if (bits == 1) frame[n >> 3] |= static_cast<Uint8>(sample << (n & 7));
    else frame[n * static_cast<std::size_t>(bits) / 8] = static_cast<Uint8>(sample);
    if (bits == 16) frame[2 * n + 1] = static_cast<Uint8>(sample >> 8);
}

}  // namespace

SegPixels::SegPixels(DcmFileFormat& file, const std::filesystem::path& path, const SegLayout& layout)
    : layout_(layout), frame_stride_(layout.pixels() * static_cast<std::size_t>(layout.bits)) {
    DcmDataset& dataset = *file.getDataset();
    const dcmtk::Syntax syntax = dcmtk::syntax_of(file);
    const E_TransferSyntax known = dataset.getOriginalXfer();
    const bool is_compressed = DcmXfer(known).isEncapsulated();
    const bool is_deflated = syntax.uid == kDeflatedFrames;
    if (is_compressed) check_expansion(path, static_cast<std::uint64_t>(layout_.frames) * ((frame_stride_ + 7) / 8));
    if (is_deflated || (syntax.known && is_jpeg2000(known))) {
        take_frames(dataset, is_deflated);
    } else {
        if (is_compressed) decode(dataset, syntax);
        take_plain(dataset);
    }
}

void SegPixels::decode(DcmDataset& dataset, const dcmtk::Syntax& syntax) const {
    if (!syntax.known || !is_decoded_by_dcmtk(dataset.getOriginalXfer()) || layout_.bits == 1)
        throw Error(ErrorKind::unsupported, fmt::format("the compression '{}' of its pixels is not supported; {}",
                                                        syntax.name, dcmtk::kUncompressed));
    if (const OFCondition decoded = dataset.chooseRepresentation(EXS_LittleEndianExplicit, nullptr); decoded.bad())
        throw corrupt(fmt::format("its compressed pixels cannot be decoded ({})", decoded.text()));
}

/// Frames of single bits follow one another without a gap (PS3.5 8.1.1).
void SegPixels::take_plain(DcmDataset& dataset) {
    const std::size_t needed = (static_cast<std::size_t>(layout_.frames) * frame_stride_ + 7) / 8;
    DcmElement* element = nullptr;
    Uint8* bytes = nullptr;
    if (dataset.findAndGetElement(DCM_PixelData, element).bad() || element->getLength() < needed ||
        element->getUint8Array(bytes).bad() || !bytes)
        throw corrupt(fmt::format("its pixel data is shorter than the {} bytes of its frames", needed));
    bytes_ = {bytes, needed};
}

/// Each frame begins with a byte of its own.
void SegPixels::take_frames(DcmDataset& dataset, bool is_deflated) {
    const std::size_t frame_bytes = (frame_stride_ + 7) / 8;
    frame_stride_ = 8 * frame_bytes;
    const dcmtk::CompressedFrames frames(dataset, layout_.frames);
    decoded_.resize(static_cast<std::size_t>(layout_.frames) * frame_bytes);
    for (std::size_t f = 0; f < static_cast<std::size_t>(layout_.frames); ++f) {
        const std::vector<Uint8> code = frames.code(static_cast<std::int64_t>(f) + 1);
        const std::span<Uint8> frame = std::span(decoded_).subspan(f * frame_bytes, frame_bytes);
        if (is_deflated) {
            inflate_frame(code, frame);
            continue;
        }
        const std::vector<std::int32_t> samples = decode_jpeg2000(code, layout_.columns, layout_.rows);
        for (std::size_t n = 0; n < samples.size(); ++n) put_sample(frame, n, layout_.bits, samples[n]);
    }
    bytes_ = decoded_;
}

}  // namespace kontur
