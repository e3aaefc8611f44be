// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_nesting.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/dicom/dcmtk.h"
#include "kontur/io/dicom/dicom_start.h"

namespace kontur {
namespace {

constexpr std::size_t kDeepest = 100;
/// Items in what is no orderly sequence of elements; each may be a level of its own to DCMTK. Eight megabytes of stack, the
/// system's default, hold about 9000 levels.
constexpr std::uint64_t kMostDisorderlyItems = 3000;
/// Of what lies deflated beside the pixels, all elements together: DCMTK takes what memory an element claims before it
/// inflates it.
constexpr std::uint64_t kMostDeflatedMb = 128;
constexpr std::uint32_t kUndefined = 0xFFFFFFFF;
constexpr std::uint64_t kNoEnd = std::numeric_limits<std::uint64_t>::max();

/// Thrown where the elements cannot be followed.
struct Disorder {
    bool inflated;  ///< among inflated content: what its elements claim cannot be known
};
struct End {};  ///< thrown where the file ends

struct Tag {
    std::uint16_t group = 0, element = 0;
    bool operator==(const Tag&) const = default;
};
constexpr Tag kItem{0xFFFE, 0xE000}, kItemEnd{0xFFFE, 0xE00D}, kSequenceEnd{0xFFFE, 0xE0DD}, kPixelData{0x7FE0, 0x0010};

/// How a stretch of elements is written.
struct Coding {
    bool explicit_vr = true, big_endian = false;
};

/// An open sequence or item.
struct Level {
    bool is_item = false;
    std::uint64_t end = kNoEnd;  ///< position; kNoEnd: closed by a delimiter
    Coding coding{};             ///< of what is in it
};

class Scanner {
public:
    explicit Scanner(InputFile& file, Coding coding) : file_(file), coding_(coding) {}

    /// All elements to the end, which is thrown; of the first one the tag may have been read.
    void scan(std::optional<Tag> first) {
        for (;; first.reset()) {
            close_ended_levels();
            const Tag tag = first ? *first : read_tag();
            if (tag == Tag{} && levels_.empty()) skip_zeros();
            if (tag.group == 0xFFFE) read_delimiter(tag);
            else read_element(tag);
        }
    }

    const Coding& coding() const { return levels_.empty() ? coding_ : levels_.back().coding; }

    std::uint64_t number(std::size_t bytes) {
        std::array<unsigned char, 4> raw{};
        if (file_.read_some(raw.data(), bytes) != bytes) throw End{};
        at_ += bytes;
        std::uint64_t value = 0;
        for (std::size_t n = 0; n < bytes; ++n)
            value |= std::uint64_t{raw[n]} << 8 * (coding().big_endian ? bytes - 1 - n : n);
        return value;
    }

    Tag read_tag() {
        const auto group = static_cast<std::uint16_t>(number(2));
        return {group, static_cast<std::uint16_t>(number(2))};
    }

    std::string text(std::size_t length) {
        std::string value(length, '\0');
        if (file_.read_some(value.data(), length) != length) throw End{};
        at_ += length;
        return value;
    }

    void skip(std::uint64_t length) {
        // Inflated content has no end that is known before.
        std::array<char, 4096> dropped;
        for (std::uint64_t left = length; left > 0;) {
            const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, dropped.size()));
            if (left > (std::uint64_t{1} << 16) && !inflated_) {
                if (left > file_.stored_bytes_left()) throw End{};
                file_.skip(left);
                break;
            }
            if (file_.read_some(dropped.data(), count) != count) throw End{};
            left -= count;
        }
        at_ += length;
    }

    void set_inflated() { inflated_ = true; }

    /// Bytes read and skipped.
    std::uint64_t position() const { return at_; }

    /// Where the zeros begin that fill the file up, counted as `position`; nullopt: there are none.
    const std::optional<std::uint64_t>& padding() const { return padding_; }

private:
    /// Some programs fill the file up with zeros behind the last element.
    void skip_zeros() {
        padding_ = at_ - 4;
        while (number(1) == 0) {
        }
        throw Disorder{inflated_};
    }

    void close_ended_levels() {
        while (!levels_.empty() && levels_.back().end <= at_) {
            if (levels_.back().end < at_) throw Disorder{inflated_};
            levels_.pop_back();
        }
    }

    void open(bool is_item, std::uint64_t length, const Coding& coding) {
        levels_.push_back({is_item, length == kUndefined ? kNoEnd : at_ + length, coding});
        if (levels_.size() > 2 * kDeepest)  // a sequence and its item are one level
            throw Error(ErrorKind::corrupt_file, fmt::format("its sequences are nested more than {} deep", kDeepest));
    }

    void read_delimiter(const Tag& tag) {
        const std::uint64_t length = number(4);
        const bool in_item = !levels_.empty() && levels_.back().is_item;
        if (levels_.empty()) throw Disorder{inflated_};
        if (tag == kItem && !in_item) open(true, length, coding());
        else if ((tag == kItemEnd && in_item) || (tag == kSequenceEnd && !in_item)) levels_.pop_back();
        else throw Disorder{inflated_};
    }

    void read_element(const Tag& tag) {
        if (!levels_.empty() && !levels_.back().is_item) throw Disorder{inflated_};
        Coding inside = coding();
        bool is_sequence = false;
        std::uint64_t length = 0;
        if (coding().explicit_vr) {
            const std::string vr = text(2);
            length = read_length(vr);
            is_sequence = vr == "SQ";
            if (vr == "UN" && length == kUndefined) inside = {false, false};
        } else {
            length = number(4);
            is_sequence = DcmTag(tag.group, tag.element).getEVR() == EVR_SQ;
        }
        if (tag == kPixelData && length == kUndefined) skip_fragments();
        else if (is_sequence || length == kUndefined) open(false, length, inside);
        else skip_value(tag, length);
    }

    void skip_value(const Tag& tag, std::uint64_t length) {
        if (!inflated_) return skip(length);
        if (tag != kPixelData) claimed_ += length;
        if (claimed_ > kMostDeflatedMb << 20)
            throw Error(ErrorKind::corrupt_file,
                        fmt::format("its deflated elements claim {} MB beside the pixels; at most {} MB are read",
                                    claimed_ >> 20, kMostDeflatedMb));
        try {
            skip(length);
        } catch (const End&) {
            throw Error(ErrorKind::corrupt_file,
                        fmt::format("a deflated element claims {} bytes, more than there are", length));
        }
    }

    std::uint64_t read_length(std::string_view vr) {
        constexpr std::string_view kShort = "AE AS AT CS DA DS DT FL FD IS LO LT PN SH SL SS ST TM UI UL US ";
        constexpr std::string_view kLong = "OB OD OF OL OV OW SQ SV UC UN UR UT UV ";
        const std::string name = std::string(vr) + " ";
        if (kShort.find(name) != std::string_view::npos) return number(2);
        if (kLong.find(name) == std::string_view::npos) throw Disorder{inflated_};
        number(2);
        return number(4);
    }

    /// Of compressed pixels; they hold no elements.
    void skip_fragments() {
        for (;;) {
            const Tag tag = read_tag();
            const std::uint64_t length = number(4);
            if (tag == kSequenceEnd) return;
            if (tag != kItem || length == kUndefined) throw Disorder{inflated_};
            skip(length);
        }
    }

    InputFile& file_;
    Coding coding_;
    std::vector<Level> levels_;
    std::uint64_t at_ = 0;
    bool inflated_ = false;
    std::optional<std::uint64_t> padding_;
    std::uint64_t claimed_ = 0;  ///< bytes of values but pixels, of inflated content
};

/// What the file's meta information says, read up to the first element of the data set.
struct Meta {
    std::string syntax;
    std::optional<Tag>
        next;  ///< the data set's first tag, which had to be read where the information does not say its length
};

Meta read_meta(Scanner& meta) {
    constexpr Tag kLength{0x0002, 0x0000}, kSyntax{0x0002, 0x0010};
    Tag tag = meta.read_tag();
    const bool has_length = tag == kLength;
    if (has_length && (meta.text(2) != "UL" || meta.number(2) != 4)) throw Disorder{false};
    const std::uint64_t length = has_length ? meta.number(4) : kNoEnd;
    if (has_length && length > 0) tag = meta.read_tag();
    std::string syntax;
    for (std::uint64_t used = 0; used < length && (has_length || tag.group == 2);) {
        const std::string vr = meta.text(2);
        const bool is_long = vr == "OB" || vr == "UN" || vr == "UT";
        if (is_long) meta.number(2);
        const std::uint64_t size = meta.number(is_long ? 4 : 2);
        if (tag == kSyntax) syntax = meta.text(static_cast<std::size_t>(std::min<std::uint64_t>(size, 64)));
        else meta.skip(size);
        used += (is_long ? 12 : 8) + size;
        if (used < length) tag = meta.read_tag();
    }
    while (!syntax.empty() && (syntax.back() == '\0' || syntax.back() == ' ')) syntax.pop_back();
    return {syntax, has_length ? std::nullopt : std::optional(tag)};
}

constexpr std::uint64_t kPreambleBytes = 132;

/// To the end; returns where the zeros begin that fill the file up.
std::optional<std::uint64_t> scan_data(Scanner& scanner, std::optional<Tag> first, std::uint64_t offset) {
    try {
        scanner.scan(first);
    } catch (const End&) {
        if (scanner.padding()) return offset + *scanner.padding();
    }
    return std::nullopt;
}

std::optional<std::uint64_t> scan(InputFile& file, const DicomStart& start) {
    const std::uint64_t begin = start.has_preamble ? kPreambleBytes : 0;
    file.skip(begin);
    if (!start.has_meta) {
        Scanner data(file, {start.explicit_vr, false});
        return scan_data(data, {}, begin);
    }
    Scanner meta(file, {});
    auto [syntax, next] = read_meta(meta);
    Scanner scanner(file, {syntax != "1.2.840.10008.1.2", syntax == "1.2.840.10008.1.2.2"});
    if (next && scanner.coding().big_endian)
        next = Tag{static_cast<std::uint16_t>(next->group << 8 | next->group >> 8),
                   static_cast<std::uint16_t>(next->element << 8 | next->element >> 8)};
    constexpr std::string_view kDeflated = "1.2.840.10008.1.2.1.99";
    if (syntax == kDeflated) {
        if (next) throw Disorder{true};  // what was read as a tag is deflated
        file.inflate_raw();
        scanner.set_inflated();
    }
    const auto padding = scan_data(scanner, next, begin + meta.position());
    return syntax == kDeflated ? std::nullopt : padding;
}

/// Items in all of the file, in either byte order.
std::uint64_t item_count(const std::filesystem::path& path) {
    InputFile file(path);
    std::uint64_t count = 0;
    std::uint32_t last = 0;
    std::array<unsigned char, 1 << 16> buffer;
    while (const std::size_t got = file.read_some(buffer.data(), buffer.size()))
        for (std::size_t n = 0; n < got; ++n) {
            last = last << 8 | buffer[n];
            count += last == 0xFEFF00E0 || last == 0xFFFEE000;
        }
    return count;
}

}  // namespace

DicomMeta read_dicom_meta(const std::filesystem::path& path) {
    const std::optional<DicomStart> start = dicom_start(path);
    if (!start || !start->has_meta) return {};
    InputFile file(path);
    const std::uint64_t begin = start->has_preamble ? kPreambleBytes : 0;
    file.skip(begin);
    Scanner scanner(file, {});
    constexpr std::uint64_t kTagBytes = 4;
    try {
        const Meta meta = read_meta(scanner);
        return {meta.syntax, begin + scanner.position() - (meta.next ? kTagBytes : 0)};
    } catch (const End&) {
    } catch (const Disorder&) {
    }
    throw Error(ErrorKind::corrupt_file, path.string() + ": its meta information breaks off");
}

std::optional<std::uint64_t> check_dicom_nesting(const std::filesystem::path& path) {
    const std::optional<DicomStart> start = dicom_start(path);
    if (!start) return std::nullopt;
    InputFile file(path);
    try {
        return scan(file, *start);
    } catch (const End&) {
    } catch (const Disorder& disorder) {
        if (disorder.inflated || item_count(path) > kMostDisorderlyItems)
            throw Error(ErrorKind::corrupt_file, path.string() + ": its elements do not follow one another as DICOM wants");
    } catch (const Error& error) {
        throw std::string_view(error.what()).starts_with(path.string()) ? error : error.with_context(path.string());
    }
    return std::nullopt;
}

}  // namespace kontur
