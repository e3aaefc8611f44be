// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/jpeg2000.h"

#include <fmt/format.h>
#include <openjpeg.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "kontur/base/error.h"

namespace kontur {
namespace {

Error corrupt(const std::string& message) { return Error(ErrorKind::corrupt_file, message); }

/// What OpenJPEG reads from.
struct Source {
    std::span<const std::uint8_t> bytes;
    std::size_t at = 0;
};

OPJ_SIZE_T read(void* to, OPJ_SIZE_T count, void* user) {
    auto& source = *static_cast<Source*>(user);
    const std::size_t left = source.bytes.size() - source.at;
    if (left == 0) return static_cast<OPJ_SIZE_T>(-1);
    const std::size_t taken = std::min<std::size_t>(count, left);
    std::memcpy(to, source.bytes.data() + source.at, taken);
    source.at += taken;
    return taken;
}

OPJ_BOOL seek(OPJ_OFF_T position, void* user) {
    auto& source = *static_cast<Source*>(user);
    if (position < 0 || static_cast<std::size_t>(position) > source.bytes.size()) return OPJ_FALSE;
    source.at = static_cast<std::size_t>(position);
    return OPJ_TRUE;
}

OPJ_OFF_T skip(OPJ_OFF_T count, void* user) {
    const auto at = static_cast<OPJ_OFF_T>(static_cast<Source*>(user)->at);
    return seek(at + count, user) ? count : -1;
}

template <auto Destroy>
struct Destroyer {
    template <class Handle>
    void operator()(Handle* handle) const {
        Destroy(handle);
    }
};
using Stream = std::unique_ptr<opj_stream_t, Destroyer<opj_stream_destroy>>;
using Image2000 = std::unique_ptr<opj_image_t, Destroyer<opj_image_destroy>>;

struct CodecDestroyer {
    void operator()(opj_codec_t* codec) const { opj_destroy_codec(codec); }
};

Stream open(Source& source) {
    Stream stream(opj_stream_default_create(OPJ_TRUE));
    opj_stream_set_user_data(stream.get(), &source, nullptr);
    opj_stream_set_user_data_length(stream.get(), source.bytes.size());
    opj_stream_set_read_function(stream.get(), read);
    opj_stream_set_seek_function(stream.get(), seek);
    opj_stream_set_skip_function(stream.get(), skip);
    return stream;
}

bool is_jp2(std::span<const std::uint8_t> code) {
    constexpr std::array<std::uint8_t, 8> kSignature{0, 0, 0, 12, 'j', 'P', ' ', ' '};
    return code.size() > kSignature.size() && std::equal(kSignature.begin(), kSignature.end(), code.begin());
}

void check_size(const opj_image_t& image, std::int64_t columns, std::int64_t rows) {
    if (image.numcomps != 1)
        throw Error(ErrorKind::unsupported,
                    fmt::format("JPEG 2000 with {} colour channels is not supported", image.numcomps));
    const std::int64_t width = std::int64_t{image.x1} - image.x0, height = std::int64_t{image.y1} - image.y0;
    if (width != columns || height != rows)
        throw corrupt(
            fmt::format("the JPEG 2000 image has {} x {} pixels, the header claims {} x {}", width, height, columns, rows));
}

}  // namespace

std::vector<std::int32_t> decode_jpeg2000(std::span<const std::uint8_t> code, std::int64_t columns, std::int64_t rows) {
    Source source{code};
    const Stream stream = open(source);
    const std::unique_ptr<opj_codec_t, CodecDestroyer> codec(
        opj_create_decompress(is_jp2(code) ? OPJ_CODEC_JP2 : OPJ_CODEC_J2K));
    opj_dparameters_t parameters;
    opj_set_default_decoder_parameters(&parameters);
    opj_image_t* header = nullptr;
    const bool has_header =
        opj_setup_decoder(codec.get(), &parameters) && opj_read_header(stream.get(), codec.get(), &header);
    const Image2000 image(header);
    if (!has_header || !image) throw corrupt("the JPEG 2000 code cannot be decoded");
    check_size(*image, columns, rows);
    if (!opj_decode(codec.get(), stream.get(), image.get()) || !opj_end_decompress(codec.get(), stream.get()))
        throw corrupt("the JPEG 2000 code cannot be decoded");
    const opj_image_comp_t& samples = image->comps[0];
    if (!samples.data || samples.w != columns || samples.h != rows) throw corrupt("the JPEG 2000 code is incomplete");
    return {samples.data, samples.data + columns * rows};
}

}  // namespace kontur
