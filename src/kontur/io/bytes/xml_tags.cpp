// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/xml_tags.h"

#include <algorithm>

#include "kontur/base/error.h"

namespace kontur {
namespace {

constexpr std::string_view kXmlBlanks = " \t\r\n";
constexpr std::size_t kMostAttributes = 64;

[[noreturn]] void corrupt(const std::string& reason) { throw Error(ErrorKind::corrupt_file, reason); }

std::string_view take_until(std::string_view& text, std::string_view any_of) {
    const std::string_view taken = text.substr(0, std::min(text.find_first_of(any_of), text.size()));
    text.remove_prefix(taken.size());
    return taken;
}

void skip_blanks(std::string_view& text) { text.remove_prefix(std::min(text.find_first_not_of(kXmlBlanks), text.size())); }

/// NAME="VALUE" or NAME='VALUE'.
void take_attribute(std::string_view& text, XmlTag& tag) {
    const std::string_view key = take_until(text, " \t\r\n=");
    skip_blanks(text);
    const bool has_value = text.starts_with('=');
    if (has_value) text.remove_prefix(1);
    skip_blanks(text);
    const char quote = text.empty() ? '\0' : text.front();
    if (!has_value || (quote != '"' && quote != '\'')) corrupt("an attribute in its XML has no value in quotes");
    text.remove_prefix(1);
    const std::size_t end = text.find(quote);
    if (end == std::string_view::npos) corrupt("an attribute in its XML does not end");
    tag.attributes.emplace(key, text.substr(0, end));
    text.remove_prefix(end + 1);
    if (tag.attributes.size() > kMostAttributes) corrupt("a tag in its XML has too many attributes");
}

/// Where the tag ends that `text` begins with, behind its "<": quotes may hold a ">".
std::size_t end_of_tag(std::string_view text) {
    char quote = '\0';
    for (std::size_t n = 0; n < text.size(); ++n) {
        if (quote) quote = text[n] == quote ? '\0' : quote;
        else if (text[n] == '"' || text[n] == '\'') quote = text[n];
        else if (text[n] == '>') return n;
    }
    corrupt("a tag in its XML does not end");
}

/// Passes over a comment, a declaration or an instruction; false at a tag.
bool skip_other(std::string_view& left) {
    const bool is_comment = left.starts_with("<!--");
    if (!is_comment && !left.starts_with("<!") && !left.starts_with("<?")) return false;
    const std::string_view mark = is_comment ? "-->" : ">";
    const std::size_t end = left.find(mark);
    if (end == std::string_view::npos) corrupt("a comment in its XML does not end");
    left.remove_prefix(end + mark.size());
    return true;
}

}  // namespace

std::string_view XmlTag::attribute(std::string_view key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? std::string_view() : found->second;
}

std::optional<XmlTag> XmlTags::next() {
    do {
        left_.remove_prefix(std::min(left_.find('<'), left_.size()));
        if (left_.empty()) return std::nullopt;
    } while (skip_other(left_));
    left_.remove_prefix(1);
    const std::size_t end = end_of_tag(left_);
    std::string_view inside = left_.substr(0, end);
    left_.remove_prefix(end + 1);
    behind_ = left_;
    XmlTag tag;
    tag.opens = !inside.starts_with('/');
    if (!tag.opens) inside.remove_prefix(1);
    tag.is_empty = inside.ends_with('/');
    if (tag.is_empty) inside.remove_suffix(1);
    tag.name = take_until(inside, kXmlBlanks);
    for (skip_blanks(inside); tag.opens && !inside.empty(); skip_blanks(inside)) take_attribute(inside, tag);
    tag.text = left_.substr(0, std::min(left_.find('<'), left_.size()));
    return tag;
}

}  // namespace kontur
