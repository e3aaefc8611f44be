// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpeg/djrplol.h>
#include <dcmtk/dcmjpls/djencode.h>
#include <dcmtk/dcmjpls/djrparam.h>
#include <dcmtk/oflog/oflog.h>
#include <openjpeg.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vector>

namespace kontur::test {

namespace detail {

/// What OpenJPEG writes to.
struct Sink {
    std::vector<std::uint8_t> bytes;
    std::size_t at = 0;
};

inline OPJ_SIZE_T write(void* from, OPJ_SIZE_T count, void* user) {
    auto& sink = *static_cast<Sink*>(user);
    sink.bytes.resize(std::max(sink.bytes.size(), sink.at + count));
    std::memcpy(sink.bytes.data() + sink.at, from, count);
    sink.at += count;
    return count;
}
inline OPJ_BOOL seek(OPJ_OFF_T position, void* user) {
    static_cast<Sink*>(user)->at = static_cast<std::size_t>(position);
    return OPJ_TRUE;
}
inline OPJ_OFF_T skip(OPJ_OFF_T count, void* user) {
    static_cast<Sink*>(user)->at += static_cast<std::size_t>(count);
    return count;
}

/// A lossless JPEG 2000 code stream.
inline std::vector<std::uint8_t> encode_jpeg2000(const std::vector<std::int32_t>& samples, unsigned columns, unsigned rows,
                                                 unsigned bits, bool is_signed) {
    opj_image_cmptparm_t component{};
    component.dx = component.dy = 1;
    component.w = columns;
    component.h = rows;
    component.prec = bits;
    component.sgnd = is_signed;
    opj_image_t* image = opj_image_create(1, &component, OPJ_CLRSPC_GRAY);
    image->x1 = columns;
    image->y1 = rows;
    std::copy(samples.begin(), samples.end(), image->comps[0].data);
    opj_cparameters_t parameters;
    opj_set_default_encoder_parameters(&parameters);
    parameters.numresolution = 2;
    opj_codec_t* codec = opj_create_compress(OPJ_CODEC_J2K);
    opj_stream_t* stream = opj_stream_default_create(OPJ_FALSE);
    Sink sink;
    opj_stream_set_user_data(stream, &sink, nullptr);
    opj_stream_set_write_function(stream, write);
    opj_stream_set_seek_function(stream, seek);
    opj_stream_set_skip_function(stream, skip);
    const bool done = opj_setup_encoder(codec, &parameters, image) && opj_start_compress(codec, image, stream) &&
                      opj_encode(codec, stream) && opj_end_compress(codec, stream);
    opj_stream_destroy(stream);
    opj_destroy_codec(codec);
    opj_image_destroy(image);
    if (!done) throw std::runtime_error("cannot encode JPEG 2000");
    return sink.bytes;
}

/// Appends a frame in `fragments` pieces of even length and its place to the offset table.
inline void store_frame(DcmPixelSequence& sequence, DcmOffsetList& offsets, std::vector<std::uint8_t> code,
                        std::size_t fragments) {
    code.resize((code.size() + 1) / 2 * 2);
    const std::size_t each = (code.size() / fragments + 1) / 2 * 2;
    Uint32 stored = 0;
    for (std::size_t begin = 0; begin < code.size(); begin += each) {
        auto item = std::make_unique<DcmPixelItem>(DcmTag(DCM_Item, EVR_OB));
        const auto length = static_cast<Uint32>(std::min(each, code.size() - begin));
        item->putUint8Array(code.data() + begin, length);
        sequence.insert(item.release());
        stored += 8 + length;
    }
    offsets.push_back(stored);
}

/// Replaces uncompressed 8- or 16-bit pixels by JPEG 2000 ones, each frame in a number of fragments.
inline void put_jpeg2000(DcmDataset& dataset, std::size_t fragments) {
    Uint16 rows = 0, columns = 0, bits = 0, sign = 0;
    dataset.findAndGetUint16(DCM_Rows, rows);
    dataset.findAndGetUint16(DCM_Columns, columns);
    dataset.findAndGetUint16(DCM_BitsAllocated, bits);
    dataset.findAndGetUint16(DCM_PixelRepresentation, sign);
    Sint32 frames = 0;
    if (dataset.findAndGetSint32(DCM_NumberOfFrames, frames).bad()) frames = 1;
    DcmElement* element = nullptr;
    Uint8* bytes = nullptr;
    if (dataset.findAndGetElement(DCM_PixelData, element).bad() || element->getUint8Array(bytes).bad())
        throw std::runtime_error("no pixels");
    auto sequence = std::make_unique<DcmPixelSequence>(DcmTag(DCM_PixelData, EVR_OB));
    auto table = std::make_unique<DcmPixelItem>(DcmTag(DCM_Item, EVR_OB));
    DcmPixelItem& offset_table = *table;
    sequence->insert(table.release());
    DcmOffsetList offsets;
    const std::size_t pixels = std::size_t{rows} * columns;
    for (std::size_t frame = 0; frame < static_cast<std::size_t>(frames); ++frame) {
        std::vector<std::int32_t> samples(pixels);
        for (std::size_t n = 0; n < pixels; ++n) {
            const std::size_t at = frame * pixels + n;
            const int low = bits == 8 ? bytes[at] : bytes[2 * at] | bytes[2 * at + 1] << 8;
            samples[n] = sign && bits == 16 ? static_cast<std::int16_t>(low) : low;
        }
        store_frame(*sequence, offsets, encode_jpeg2000(samples, columns, rows, bits, sign != 0), fragments);
    }
    offset_table.createOffsetTable(offsets);
    static_cast<DcmPixelData*>(element)->putOriginalRepresentation(EXS_JPEG2000LosslessOnly, nullptr, sequence.release());
}

}  // namespace detail

/// Rewrites every DICOM file in the folder with its pixels compressed without loss (EXS_JPEGProcess14SV1: JPEG,
/// EXS_JPEGLSLossless: JPEG-LS, EXS_JPEG2000LosslessOnly: JPEG 2000, each frame in a number of fragments).
inline void recompress(const std::filesystem::path& folder, E_TransferSyntax syntax, std::size_t fragments = 1) {
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);
    DJEncoderRegistration::registerCodecs();
    DJLSEncoderRegistration::registerCodecs();
    const DJ_RPLossless jpeg;
    const DJLSRepresentationParameter jpeg_ls;
    const DcmRepresentationParameter* how = &jpeg_ls;
    if (syntax == EXS_JPEGProcess14SV1) how = &jpeg;
    if (syntax == EXS_JPEG2000LosslessOnly) how = nullptr;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        DcmFileFormat file;
        const OFFilename name(entry.path().c_str());
        if (file.loadFile(name).bad() || file.loadAllDataIntoMemory().bad())
            throw std::runtime_error("cannot read " + entry.path().string());
        if (syntax == EXS_JPEG2000LosslessOnly) detail::put_jpeg2000(*file.getDataset(), fragments);
        if (file.getDataset()->chooseRepresentation(syntax, how).bad() || file.saveFile(name, syntax).bad())
            throw std::runtime_error("cannot recompress " + entry.path().string());
    }
}

}  // namespace kontur::test
