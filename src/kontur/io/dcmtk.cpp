// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dcmtk.h"

#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <dcmtk/oflog/oflog.h>

#include <iconv.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string_view>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/decimal_string.h"
#include "kontur/io/dicom_nesting.h"

namespace kontur::dcmtk {
namespace {

std::string raw_text(DcmItem& item, const DcmTagKey& tag) {
    OFString value;
    if (item.findAndGetOFStringArray(tag, value).bad()) return {};
    std::string text(value.c_str(), value.length());
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

void load(DcmFileFormat& file, const std::filesystem::path& path, const DcmTagKey& stop) {
    set_up();
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure)) throw Error(ErrorKind::io, path.string() + ": no such file");
    check_dicom_nesting(path);
    const OFCondition loaded =
        file.loadFileUntilTag(OFFilename(path.c_str()), EXS_Unknown, EGL_noChange, DCM_MaxReadLength, ERM_fileOnly, stop);
    if (loaded.good()) return;
    std::FILE* readable = std::fopen(path.c_str(), "rb");
    if (!readable) throw Error(ErrorKind::io, path.string() + ": cannot be opened for reading");
    std::fclose(readable);
    throw Error(ErrorKind::corrupt_file, path.string() + ": not a complete DICOM file (" + loaded.text() + ")");
}

std::string text(DcmItem& item, const DcmTagKey& tag) {
    constexpr char kEscape = '\x1b';  // with which ISO 2022 turns ASCII into other characters
    const std::string value = raw_text(item, tag);
    const bool ascii =
        std::all_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80 && c != kEscape; });
    const std::string utf8 = ascii ? value : to_utf8(item, value);
    return printable_utf8(is_utf8(utf8) ? utf8 : latin1_to_utf8(utf8));
}

std::optional<std::int64_t> integer(DcmItem& item, const DcmTagKey& tag) {
    Uint16 number = 0;
    DcmElement* element = nullptr;
    if (item.findAndGetElement(tag, element).bad() || element->getLength() == 0) return std::nullopt;
    if (element->getUint16(number).good()) return number;
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
