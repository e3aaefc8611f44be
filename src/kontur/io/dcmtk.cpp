// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dcmtk.h"

#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <dcmtk/oflog/oflog.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <mutex>
#include <string_view>

#include "kontur/base/error.h"
#include "kontur/io/decimal_string.h"

namespace kontur::dcmtk {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Length of the well-formed UTF-8 sequence at the front; 0 when there is none.
std::size_t utf8_sequence(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : (lead & 0xF0) == 0xE0       ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if (!is_continuation(text[i])) return 0;
    const auto second = length > 1 ? static_cast<unsigned char>(text[1]) : 0;
    const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
    const bool surrogate = lead == 0xED && second >= 0xA0, beyond = lead == 0xF4 && second >= 0x90;
    return overlong || surrogate || beyond ? 0 : length;
}

/// Names travel into JSON reports, which must be UTF-8 whatever a file claims about itself; control characters would
/// break one-line messages.
std::string printable_utf8(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = utf8_sequence(text);
        const bool control = length == 1 && (static_cast<unsigned char>(text[0]) < 0x20 || text[0] == 0x7F);
        if (length == 0 || control) result += '?';
        else result += text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return result;
}

std::string raw_text(DcmItem& item, const DcmTagKey& tag) {
    OFString value;
    if (item.findAndGetOFStringArray(tag, value).bad()) return {};
    std::string text(value.c_str(), value.length());
    while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
    text.erase(0, text.find_first_not_of(' '));
    return text;
}

/// Converted by the character set of the nearest enclosing item that declares one; unchanged when that fails.
std::string to_utf8(DcmItem& item, const std::string& value) {
    DcmItem* declaring = &item;
    while (declaring && !declaring->tagExists(DCM_SpecificCharacterSet)) declaring = declaring->getParentItem();
    DcmSpecificCharacterSet characters;
    OFString converted;
    const bool done = declaring && characters.selectCharacterSet(*declaring).good() &&
                      characters.convertString(value.c_str(), value.size(), converted).good();
    return done ? std::string(converted.c_str(), converted.length()) : value;
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
    const OFCondition loaded =
        file.loadFileUntilTag(OFFilename(path.c_str()), EXS_Unknown, EGL_noChange, DCM_MaxReadLength, ERM_fileOnly, stop);
    if (loaded.good()) return;
    std::FILE* readable = std::fopen(path.c_str(), "rb");
    if (!readable) throw Error(ErrorKind::io, path.string() + ": cannot be opened for reading");
    std::fclose(readable);
    throw Error(ErrorKind::corrupt_file, path.string() + ": not a complete DICOM file (" + loaded.text() + ")");
}

std::string text(DcmItem& item, const DcmTagKey& tag) {
    const std::string value = raw_text(item, tag);
    const bool ascii = std::all_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
    return printable_utf8(ascii ? value : to_utf8(item, value));
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
