// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dcmtk.h"

#include <dcmtk/dcmdata/dcistrmb.h>
#include <dcmtk/dcmdata/dcistrmf.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <dcmtk/oflog/oflog.h>

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <span>
#include <string_view>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/dicom/decimal_string.h"
#include "kontur/io/dicom/dicom_nesting.h"
#include "kontur/io/dicom/dicom_start.h"

namespace kontur::dcmtk {
namespace {

/// Numbers in a row, little-endian as all of unknown type are (PS3.5 6.2.2), as text.
template <class Number>
std::string numbers_as_text(std::span<const Uint8> bytes) {
    std::string text;
    for (std::size_t at = 0; at + sizeof(Number) <= bytes.size(); at += sizeof(Number)) {
        Number number;
        std::memcpy(&number, &bytes[at], sizeof(Number));
        text += fmt::format("{}{}", text.empty() ? "" : "\\", number);
    }
    return text;
}

/// Of an element of unknown type (VR UN), as which some archives keep what they did not know: what the dictionary says
/// about it. DCMTK would do so by itself, but then for sequences, too, behind the check of their nesting.
std::string text_of_unknown(DcmElement& element, const DcmTagKey& tag) {
    Uint8* found = nullptr;
    if (element.getUint8Array(found).bad() || !found) return {};
    const std::span<const Uint8> bytes(found, element.getLength());
    switch (DcmTag(tag).getEVR()) {
        case EVR_US:
        case EVR_xs:
            return numbers_as_text<std::uint16_t>(bytes);
        case EVR_SS:
            return numbers_as_text<std::int16_t>(bytes);
        case EVR_UL:
            return numbers_as_text<std::uint32_t>(bytes);
        case EVR_SL:
            return numbers_as_text<std::int32_t>(bytes);
        case EVR_FL:
            return numbers_as_text<float>(bytes);
        case EVR_FD:
            return numbers_as_text<double>(bytes);
        default:
            return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
}

std::string raw_text(DcmItem& item, const DcmTagKey& tag) {
    DcmElement* element = nullptr;
    if (item.findAndGetElement(tag, element).bad() || element->getLength() == 0) return {};
    OFString value;
    const bool unknown = element->ident() == EVR_UN;
    if (!unknown && element->getOFStringArray(value).bad()) return {};
    std::string text = unknown ? text_of_unknown(*element, tag) : std::string(value.c_str(), value.length());
    while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
    text.erase(0, text.find_first_not_of(' '));
    return text;
}

/// Of text in Japanese sets (ISO 2022 IR 13, 87 and 159), of which DCMTK asks iconv by names that it may not know. nullopt:
/// it is no such text.
std::optional<std::string> japanese_to_utf8(const std::string& value) {
    std::string input;
    for (const char c : value) {
        const bool katakana = static_cast<unsigned char>(c) >= 0x80;  // of IR 13, which ISO-2022-JP has in 7 bits
        input += katakana ? std::string("\x1b(I") + static_cast<char>(c & 0x7F) + "\x1b(B" : std::string(1, c);
    }
    const iconv_t opened = ::iconv_open("UTF-8", "ISO-2022-JP-2");
    if (reinterpret_cast<std::intptr_t>(opened) == -1) return std::nullopt;
    const std::unique_ptr<void, int (*)(iconv_t)> converter(opened, &::iconv_close);
    std::string utf8(4 * input.size(), '\0');
    char *from = input.data(), *to = utf8.data();
    std::size_t left = input.size(), room = utf8.size();
    if (::iconv(opened, &from, &left, &to, &room) == static_cast<std::size_t>(-1)) return std::nullopt;
    utf8.resize(utf8.size() - room);
    return utf8;
}

/// Converted by the character set of the nearest enclosing item that declares one; unchanged when that fails.
std::string to_utf8(DcmItem& item, const std::string& value) {
    DcmItem* declaring = &item;
    while (declaring && !declaring->tagExists(DCM_SpecificCharacterSet)) declaring = declaring->getParentItem();
    DcmSpecificCharacterSet characters;
    OFString converted;
    const bool done = declaring && characters.selectCharacterSet(*declaring).good() &&
                      characters.convertString(value.c_str(), value.size(), converted).good();
    if (done) return {converted.c_str(), converted.length()};
    const bool escapes = value.find('\x1b') != std::string::npos;
    return escapes ? japanese_to_utf8(value).value_or(value) : value;
}

}  // namespace

void set_up() {
    static std::once_flag once;
    std::call_once(once, [] {
        OFLog::configure(OFLogger::OFF_LOG_LEVEL);
        DcmRLEDecoderRegistration::registerCodecs();
        DJDecoderRegistration::registerCodecs();
        DJLSDecoderRegistration::registerCodecs();
    });
    if (!dcmDataDict.isDictionaryLoaded())
        throw Error(ErrorKind::io, "DCMTK's data dictionary was not found; set DCMDICTPATH to its file dicom.dic");
}

namespace {

/// Newer than DCMTK 3.6.7 (PS3.6 A-1).
constexpr std::array<std::pair<std::string_view, std::string_view>, 13> kNewerSyntaxes{{
    {"1.2.840.10008.1.2.1.98", "Encapsulated Uncompressed Explicit VR Little Endian"},
    {"1.2.840.10008.1.2.4.110", "JPEG XL Lossless"},
    {"1.2.840.10008.1.2.4.111", "JPEG XL JPEG Recompression"},
    {"1.2.840.10008.1.2.4.112", "JPEG XL"},
    {"1.2.840.10008.1.2.4.201", "High-Throughput JPEG 2000 (Lossless Only)"},
    {"1.2.840.10008.1.2.4.202", "High-Throughput JPEG 2000 with RPCL Options (Lossless Only)"},
    {"1.2.840.10008.1.2.4.203", "High-Throughput JPEG 2000"},
    {"1.2.840.10008.1.2.4.204", "JPIP HTJ2K Referenced"},
    {"1.2.840.10008.1.2.4.205", "JPIP HTJ2K Referenced Deflate"},
    {"1.2.840.10008.1.2.7.1", "SMPTE ST 2110-20 Uncompressed Progressive Active Video"},
    {"1.2.840.10008.1.2.7.2", "SMPTE ST 2110-20 Uncompressed Interlaced Active Video"},
    {"1.2.840.10008.1.2.7.3", "SMPTE ST 2110-30 PCM Digital Audio"},
    {"1.2.840.10008.1.2.8.1", "Deflated Image Frame Compression"},
}};

std::string name_of_syntax(const std::string& uid) {
    const auto found =
        std::find_if(kNewerSyntaxes.begin(), kNewerSyntaxes.end(), [&](const auto& s) { return s.first == uid; });
    return found == kNewerSyntaxes.end() ? uid : std::string(found->second);
}

bool is_known(const std::string& uid) { return uid.empty() || DcmXfer(uid.c_str()).getXfer() != EXS_Unknown; }

/// Reads the data set as if its pixels were run-length coded; they are not touched before they are decoded.
OFCondition load_unknown(DcmFileFormat& file, const std::filesystem::path& path, const DicomMeta& meta,
                         const DcmTagKey& stop) {
    DcmInputFileStream stream(OFFilename(path.c_str()), static_cast<offile_off_t>(meta.data_offset));
    if (stream.status().bad()) return stream.status();
    file.getMetaInfo()->putAndInsertString(DCM_TransferSyntaxUID, meta.syntax.c_str());
    DcmDataset& dataset = *file.getDataset();
    dataset.transferInit();
    const OFCondition loaded = dataset.readUntilTag(stream, EXS_RLELossless, EGL_noChange, DCM_MaxReadLength, stop);
    dataset.transferEnd();
    return loaded;
}

OFCondition load_known(DcmFileFormat& file, const std::filesystem::path& path, const DcmTagKey& stop) {
    const DicomStart start = *dicom_start(path);
    // Not left to DCMTK, whose guess may differ from what was scanned for nesting.
    const E_TransferSyntax syntax = start.has_meta      ? EXS_Unknown
                                    : start.explicit_vr ? EXS_LittleEndianExplicit
                                                        : EXS_LittleEndianImplicit;
    const E_FileReadMode mode = start.has_preamble ? ERM_fileOnly : start.has_meta ? ERM_autoDetect : ERM_dataset;
    return file.loadFileUntilTag(OFFilename(path.c_str()), syntax, EGL_noChange, DCM_MaxReadLength, mode, stop);
}

/// As if the file ended at `end`, behind which DCMTK would take zeros for elements.
OFCondition load_first(DcmFileFormat& file, const std::filesystem::path& path, std::uint64_t end) {
    std::vector<unsigned char> bytes(end);
    InputFile(path).read(bytes.data(), bytes.size());
    DcmInputBufferStream stream;
    stream.setBuffer(bytes.data(), static_cast<offile_off_t>(bytes.size()));
    stream.setEos();
    file.transferInit();
    OFCondition loaded = file.read(stream);
    file.transferEnd();
    if (loaded.good()) loaded = file.loadAllDataIntoMemory();
    return loaded;
}

}  // namespace

void load(DcmFileFormat& file, const std::filesystem::path& path, const DcmTagKey& stop) {
    set_up();
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure)) throw Error(ErrorKind::io, path.string() + ": no such file");
    if (!dicom_start(path))  // which DCMTK might read all the same, unchecked
        throw Error(ErrorKind::corrupt_file, path.string() + ": not a complete DICOM file (it does not begin as one)");
    const std::optional<std::uint64_t> padding = check_dicom_nesting(path);
    const DicomMeta meta = read_dicom_meta(path);
    const bool known = is_known(meta.syntax);
    const bool is_cut = padding && known && stop == DCM_UndefinedTagKey;
    const OFCondition loaded = is_cut  ? load_first(file, path, *padding)
                               : known ? load_known(file, path, stop)
                                       : load_unknown(file, path, meta, stop);
    if (loaded.good()) return;
    if (!known)
        throw Error(ErrorKind::unsupported, fmt::format("{}: the transfer syntax '{}' is not supported; {}", path.string(),
                                                        name_of_syntax(meta.syntax), kUncompressed));
    throw Error(ErrorKind::corrupt_file, path.string() + ": not a complete DICOM file (" + loaded.text() + ")");
}

Syntax syntax_of(DcmFileFormat& file) {
    OFString uid;
    file.getMetaInfo()->findAndGetOFString(DCM_TransferSyntaxUID, uid);
    if (const std::string written(uid.c_str()); !is_known(written)) return {written, name_of_syntax(written), false};
    const DcmXfer syntax(file.getDataset()->getOriginalXfer());
    return {syntax.getXferID(), syntax.getXferName(), true};
}

namespace {

std::string utf8_text(DcmItem& item, const DcmTagKey& tag) {
    constexpr char kEscape = '\x1b';  // with which ISO 2022 turns ASCII into other characters
    const std::string value = raw_text(item, tag);
    const bool ascii =
        std::all_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80 && c != kEscape; });
    const std::string utf8 = ascii ? value : to_utf8(item, value);
    return is_utf8(utf8) ? utf8 : latin1_to_utf8(utf8);
}

}  // namespace

std::string text(DcmItem& item, const DcmTagKey& tag) { return printable_utf8(utf8_text(item, tag)); }

std::string lines(DcmItem& item, const DcmTagKey& tag) {
    std::string all;
    std::string_view rest;
    const std::string whole = utf8_text(item, tag);
    for (rest = whole; !rest.empty();) {
        const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
        all += printable_utf8(rest.substr(0, end));
        if (end < rest.size()) all += '\n';
        rest.remove_prefix(std::min(end + (rest.substr(end).starts_with("\r\n") ? 2 : 1), rest.size()));
    }
    return all;
}

std::optional<std::int64_t> integer(DcmItem& item, const DcmTagKey& tag) {
    Uint16 number = 0;
    DcmElement* element = nullptr;
    if (item.findAndGetElement(tag, element).bad() || element->getLength() == 0) return std::nullopt;
    if (element->ident() != EVR_UN && element->getUint16(number).good()) return number;
    const std::string value = raw_text(item, tag);
    if (value.empty()) return std::nullopt;
    const std::string_view first = std::string_view(value).substr(0, value.find('\\'));
    std::int64_t result = 0;
    const char* begin = first.data() + (first.starts_with('+') ? 1 : 0);
    const auto [end, status] = std::from_chars(begin, first.data() + first.size(), result);
    if (status != std::errc() || end != first.data() + first.size())
        throw Error(ErrorKind::corrupt_file, tag_name(tag) + " is not an integer");
    return result;
}

std::vector<double> decimals(DcmItem& item, const DcmTagKey& tag) {
    try {
        return parse_decimal_string(raw_text(item, tag));
    } catch (const Error& error) {
        throw error.with_context(tag_name(tag));
    }
}

std::vector<DcmItem*> items(DcmItem& item, const DcmTagKey& sequence) {
    std::vector<DcmItem*> result;
    DcmSequenceOfItems* found = nullptr;
    if (item.findAndGetSequence(sequence, found).bad() || !found) return result;
    for (DcmObject* child = nullptr; (child = found->nextInContainer(child)) != nullptr;)
        if (auto* entry = dynamic_cast<DcmItem*>(child)) result.push_back(entry);
    return result;
}

std::string tag_name(const DcmTagKey& tag) {
    std::array<char, 16> number{};
    std::snprintf(number.data(), number.size(), "(%04x,%04x)", tag.getGroup(), tag.getElement());
    return std::string(DcmTag(tag).getTagName()) + " " + number.data();
}

}  // namespace kontur::dcmtk
