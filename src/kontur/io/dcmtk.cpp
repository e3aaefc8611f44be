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
