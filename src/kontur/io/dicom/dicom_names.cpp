// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kontur/base/printable.h"
#include "kontur/io/dicom/dicom_document.h"

namespace kontur::dcmtk {
namespace {

constexpr std::size_t kMostCharacters = 64;  ///< of VR LO, PS3.5 table 6.2-1
constexpr std::size_t kMostQuoted = 160;

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

std::size_t characters_of(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

/// Blanks at both ends mean nothing in DICOM.
std::string_view without_blanks(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    return text.substr(0, text.find_last_not_of(' ') + 1);
}

/// `name` with a number behind it that makes it none of those taken.
std::string told_apart(const std::string& name, const std::map<std::string, std::string>& taken) {
    for (std::size_t number = 2;; ++number) {
        const std::string suffix = fmt::format(" ({})", number);
        std::string other = one_value(name, kMostCharacters - suffix.size()) + suffix;
        if (!taken.contains(other)) return other;
    }
}

}  // namespace

std::string noted_value(std::string_view text, std::size_t max_characters, const std::string& what,
                        std::vector<std::string>& notes) {
    std::string stored = one_value(text, max_characters);
    if (stored == text) return stored;
    const std::size_t characters = characters_of(text);
    const std::string reason =
        characters > max_characters
            ? fmt::format("has {} characters, of which DICOM has room for {}", characters, max_characters)
            : std::string("has backslashes or control characters, which DICOM cannot hold there");
    notes.push_back(fmt::format("{} {}; it is written as '{}'", what, reason, stored));
    return stored;
}

std::string noted_text(std::string_view text, std::size_t max_characters, const std::string& what,
                       std::vector<std::string>& notes) {
    check_utf8(text, what);
    std::string stored;
    std::size_t characters = 0;
    for (const char c : text) {
        const std::string_view written = c == '\n' ? "\r\n" : is_control(c) ? " " : std::string_view(&c, 1);
        if (!is_continuation(c)) characters += written.size();
        if (characters > max_characters) break;
        stored += written;
    }
    if (characters > max_characters)
        notes.push_back(fmt::format("{} is longer than the {} characters for which DICOM has room; its end is left out",
                                    what, max_characters));
    return stored;
}

std::vector<std::string> stored_names(const std::vector<std::string>& names, const std::string& what,
                                      std::vector<std::string>& notes) {
    std::map<std::string, std::string> taken;  // what is stored, and what it was
    std::vector<std::string> stored;
    for (std::size_t n = 0; n < names.size(); ++n) {
        check_utf8(names[n], fmt::format("the name of {} {},", what, n + 1));
        std::vector<std::string> changed;
        const std::string subject = fmt::format("the name '{}' of {} {}", shortened(names[n], kMostQuoted), what, n + 1);
        std::string name{without_blanks(noted_value(names[n], kMostCharacters, subject, changed))};
        const auto [other, is_new] = taken.emplace(name, names[n]);
        if (!is_new && without_blanks(other->second) != without_blanks(names[n])) {
            name = told_apart(name, taken);
            taken.emplace(name, names[n]);
            changed = {
                fmt::format("{} would be that of another one in DICOM, which has room for {} characters and no "
                            "backslashes; it is written as '{}'",
                            subject, kMostCharacters, name)};
        }
        notes.insert(notes.end(), changed.begin(), changed.end());
        stored.push_back(std::move(name));
    }
    return stored;
}

}  // namespace kontur::dcmtk
