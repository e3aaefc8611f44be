// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_frames.h"
#include "kontur/io/dicom/jpeg2000.h"

namespace kontur {
namespace {

/// Deflate and run-length coding cannot shrink more than about a thousandfold; small slices are let through whatever their
/// coding, because a constant image shrinks without limit in JPEG-LS.
constexpr std::int64_t kMaxExpansion = 1100;
constexpr std::int64_t kAlwaysAllowedBytes = std::int64_t{64} << 20;

Error corrupt(const std::string& message) { return Error(ErrorKind::corrupt_file, message); }

/// How the stored integers lie in the pixel data.
struct PixelLayout {
    std::int64_t bytes = 0;  ///< per sample
    int shift = 0;           ///< of the lowest stored bit
    int bits = 0;
    bool is_signed = false;
};

PixelLayout read_layout(DcmDataset& dataset) {
    const std::int64_t allocated = dcmtk::integer(dataset, DCM_BitsAllocated).value_or(0);
    const std::int64_t stored = dcmtk::integer(dataset, DCM_BitsStored).value_or(allocated);
    const std::int64_t high = dcmtk::integer(dataset, DCM_HighBit).value_or(stored - 1);
    if (allocated != 8 && allocated != 16 && allocated != 32)
        throw Error(ErrorKind::unsupported, fmt::format("{} bits per pixel are not supported; 8, 16 and 32 are", allocated));
    if (stored < 1 || stored > allocated || high < stored - 1 || high >= allocated)
        throw corrupt(fmt::format("{} bits stored below bit {} do not fit into {} bits allocated", stored, high, allocated));
    return {allocated / 8, static_cast<int>(high - stored + 1), static_cast<int>(stored),
            dcmtk::integer(dataset, DCM_PixelRepresentation).value_or(0) == 1};
}

void check_expansion(const DicomHeader& header, std::int64_t bytes) {
    const auto file_bytes = static_cast<std::int64_t>(std::filesystem::file_size(header.path));
    if (bytes > kAlwaysAllowedBytes && bytes / kMaxExpansion > file_bytes)
        throw corrupt(fmt::format("the header claims {} bytes of pixels, the file has {} bytes", bytes, file_bytes));
}

bool is_jpeg2000(DcmDataset& dataset) {
    const E_TransferSyntax syntax = dataset.getCurrentXfer();
    return syntax == EXS_JPEG2000LosslessOnly || syntax == EXS_JPEG2000;
}

void decompress(DcmDataset& dataset) {
    if (!DcmXfer(dataset.getCurrentXfer()).isEncapsulated()) return;
    const OFCondition decoded = dataset.chooseRepresentation(EXS_LittleEndianExplicit, nullptr);
    if (decoded.bad()) throw corrupt(fmt::format("the compressed pixels cannot be decoded ({})", decoded.text()));
}

/// The pixel data of all frames, little-endian. The bytes belong to `dataset`.
std::span<const Uint8> pixel_bytes(DcmDataset& dataset, std::int64_t expected) {
    DcmElement* element = nullptr;
    if (dataset.findAndGetElement(DCM_PixelData, element).bad()) throw corrupt("the file ends before its pixels");
    const std::int64_t held = element->getLength();
    Uint8* bytes = nullptr;
    if (held < expected || element->getUint8Array(bytes).bad() || !bytes)
        throw corrupt(fmt::format("the pixel data has {} bytes, the header claims {}", held, expected));
    return {bytes, static_cast<std::size_t>(expected)};
}

/// One byte over and over, less than a frame of it, as some programs fill their files up.
bool is_padding(DcmElement& pixels, std::int64_t claimed, std::int64_t frame_bytes) {
    const std::int64_t held = pixels.getLength();
    Uint8* bytes = nullptr;
    if (held - claimed >= frame_bytes || pixels.getUint8Array(bytes).bad() || !bytes) return false;
    return std::all_of(bytes + claimed, bytes + held, [&](Uint8 byte) { return byte == bytes[claimed]; });
}

/// A header that claims less than the file holds would make a part of the image into all of it.
void check_no_more(DcmDataset& dataset, std::int64_t claimed, std::int64_t row_bytes, std::int64_t frame_bytes) {
    DcmElement* element = nullptr;
    if (dataset.findAndGetElement(DCM_PixelData, element).bad()) return;
    const std::int64_t held = element->getLength();
    if (held - claimed >= std::max<std::int64_t>(row_bytes, 2) && !is_padding(*element, claimed, frame_bytes))
        throw corrupt(fmt::format("the pixel data has {} bytes, the header claims {}", held, claimed));
}

/// The lowest bits as a number, sign-extended where the layout is signed.
std::int64_t extended(std::uint64_t raw, const PixelLayout& layout) {
    raw &= (std::uint64_t{1} << layout.bits) - 1;
    const bool negative = layout.is_signed && (raw >> (layout.bits - 1)) != 0;
    return static_cast<std::int64_t>(raw) - (negative ? std::int64_t{1} << layout.bits : 0);
}

/// The integer of the layout in little-endian bytes, sign-extended.
std::int64_t stored_value(std::span<const Uint8> bytes, const PixelLayout& layout) {
    std::uint64_t raw = 0;
    for (std::size_t byte = 0; byte < bytes.size(); ++byte) raw |= std::uint64_t{bytes[byte]} << (8 * byte);
    return extended(raw >> layout.shift, layout);
}

/// A file with its pixels, for as long as slices are read from it one after another.
class PixelFile {
public:
    explicit PixelFile(const DicomHeader& any_slice) : path_(any_slice.path) {
        dcmtk::load(file_, path_);
        const std::int64_t pixels = any_slice.frames * any_slice.rows * any_slice.columns;
        check_expansion(any_slice, pixels * read_layout(dataset()).bytes);
        if (!is_jpeg2000(dataset())) decompress(dataset());
        // A decoder may change the layout, so it counts as it stands after decoding.
        layout_ = read_layout(dataset());
        if (is_jpeg2000(dataset())) compressed_.emplace(dataset(), any_slice.frames);
        else
            check_no_more(dataset(), pixels * layout_.bytes, any_slice.columns * layout_.bytes,
                          any_slice.rows * any_slice.columns * layout_.bytes);
    }

    const std::filesystem::path& path() const { return path_; }

    std::vector<std::int64_t> stored_values(const DicomHeader& slice) {
        return compressed_ ? decoded_values(slice) : plain_values(slice);
    }

private:
    DcmDataset& dataset() { return *file_.getDataset(); }

    std::vector<std::int64_t> plain_values(const DicomHeader& slice) {
        const std::int64_t pixels = slice.rows * slice.columns, frame = slice.frame.value_or(1);
        const auto stride = static_cast<std::size_t>(layout_.bytes);
        const auto first = static_cast<std::size_t>((frame - 1) * pixels) * stride;
        const std::span<const Uint8> bytes = pixel_bytes(dataset(), frame * pixels * layout_.bytes).subspan(first);
        std::vector<std::int64_t> values(static_cast<std::size_t>(pixels));
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = stored_value(bytes.subspan(i * stride, stride), layout_);
        return values;
    }

    /// The decoded bits mean what the header says, whatever sign the code stream claims.
    std::vector<std::int64_t> decoded_values(const DicomHeader& slice) {
        const std::vector<Uint8> code = compressed_->code(slice.frame.value_or(1));
        const std::vector<std::int32_t> decoded = decode_jpeg2000(code, slice.columns, slice.rows);
        std::vector<std::int64_t> values(decoded.size());
        std::transform(decoded.begin(), decoded.end(), values.begin(),
                       [&](std::int32_t value) { return extended(static_cast<std::uint32_t>(value), layout_); });
        return values;
    }

    std::filesystem::path path_;
    DcmFileFormat file_;
    PixelLayout layout_;
    std::optional<dcmtk::CompressedFrames> compressed_;  ///< only of JPEG 2000
};

/// Keeps the file that it read last: the frames of one come one after another.
class SliceReader {
public:
    /// One slice in modality units.
    std::vector<double> read(const DicomHeader& slice) {
        try {
            if (!file_ || file_->path() != slice.path) file_ = std::make_unique<PixelFile>(slice);
            const std::vector<std::int64_t> stored = file_->stored_values(slice);
            std::vector<double> values(stored.size());
            std::transform(stored.begin(), stored.end(), values.begin(), [&](std::int64_t value) {
                return static_cast<double>(value) * slice.rescale.slope + slice.rescale.intercept;
            });
            return values;
        } catch (const Error& error) {
            if (std::string_view(error.what()).starts_with(slice.path.string())) throw;
            throw error.with_context(slice.path.string());
        }
    }

private:
    std::unique_ptr<PixelFile> file_;
};

bool is_integer(double value) { return value == std::floor(value); }

bool has_integer_rescale(const DicomHeader& slice) {
    return is_integer(slice.rescale.slope) && is_integer(slice.rescale.intercept);
}

/// Samples appended slice by slice, moved to a wider type as soon as a value asks for it: the whole volume never exists in
/// more than one copy for long, and no pass over it is needed to find its range.
class GrowingSamples {
public:
    GrowingSamples(bool real, std::size_t capacity) : capacity_(capacity) {
        if (real) samples_.emplace<std::vector<float>>();
    }

    void append(const std::vector<double>& values) {
        if (!std::holds_alternative<std::vector<float>>(samples_)) widen_for(values);
        std::visit([&](auto& samples) { append_to(samples, values); }, samples_);
    }

    Image::Samples take() && { return std::move(samples_); }

private:
    template <typename T>
    bool holds() const {
        return low_ >= std::numeric_limits<T>::lowest() && high_ <= std::numeric_limits<T>::max();
    }

    template <typename T>
    void become() {
        if (std::holds_alternative<std::vector<T>>(samples_)) return;
        std::vector<T> wider;
        wider.reserve(capacity_);
        std::visit([&](const auto& samples) { append_to(wider, samples); }, samples_);
        samples_ = std::move(wider);
    }

    template <typename T, typename Values>
    static void append_to(std::vector<T>& samples, const Values& values) {
        for (const auto value : values) samples.push_back(static_cast<T>(value));
    }

    void widen_for(const std::vector<double>& values) {
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        low_ = std::min(low_, *low);
        high_ = std::max(high_, *high);
        if (holds<std::uint8_t>()) become<std::uint8_t>();
        else if (holds<std::int16_t>()) become<std::int16_t>();
        else if (holds<std::uint16_t>()) become<std::uint16_t>();
        else if (holds<std::int32_t>()) become<std::int32_t>();
        else become<float>();
    }

    std::size_t capacity_;
    double low_ = 0, high_ = 0;
    Image::Samples samples_;
};

}  // namespace

void check_pixel_formats(const DicomStack& stack) {
    for (const DicomHeader& slice : stack.slices) {
        const auto refuse = [&](const std::string& what) {
            throw Error(ErrorKind::unsupported, fmt::format("{}: {}", slice.path.string(), what));
        };
        if (!slice.decodable)
            refuse(fmt::format("the compression '{}' is not supported; {}", slice.transfer_syntax, dcmtk::kUncompressed));
        const std::string& meaning = slice.photometric_interpretation;
        if (meaning != "MONOCHROME2" && meaning != "MONOCHROME1")
            refuse(
                fmt::format("the photometric interpretation '{}' is not supported (only MONOCHROME2 and MONOCHROME1 are); "
                            "export the images as grey values first",
                            meaning));
        if (slice.has_lookup_table)
            refuse("a modality lookup table is not supported; export the images with a rescale slope first");
        if (slice.bits_stored < 1 || slice.bits_stored > 32)
            refuse(fmt::format("a depth of {} bits is not supported; 1 to 32 are", slice.bits_stored));
    }
}

Image::Samples read_pixels(const DicomStack& stack, const Work& work) {
    const std::size_t slices = stack.slices.size();
    const DicomHeader& first = stack.slices.front();
    const bool integral = std::all_of(stack.slices.begin(), stack.slices.end(), has_integer_rescale);
    GrowingSamples samples(!integral, slices * static_cast<std::size_t>(first.rows * first.columns));
    SliceReader reader;
    for (std::size_t k = 0; k < slices; ++k) {
        work.report("read slices", static_cast<double>(k) / static_cast<double>(slices));
        samples.append(reader.read(stack.slices[k]));
    }
    work.report("read slices", 1);
    return std::move(samples).take();
}

}  // namespace kontur
