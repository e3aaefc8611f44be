// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace kontur {

/// One tag of an XML text. Internal to io, as is the rest of this file.
struct XmlTag {
    std::string_view name;
    std::map<std::string_view, std::string_view> attributes;  ///< as written: numbers and words have nothing to unescape
    bool opens = true;                                        ///< false for </name>
    bool is_empty = false;                                    ///< <name/>
    std::string_view text;                                    ///< behind the tag, up to the next one

    /// "" when it is not there.
    std::string_view attribute(std::string_view key) const;
};

/// Tags one after the other, of as much of XML as VTK's files use: comments, declarations and instructions are passed over,
/// nothing is checked against the tags before.
class XmlTags {
public:
    explicit XmlTags(std::string_view text) : left_(text) {}

    /// nullopt at the end. Throws Error(corrupt_file) for a tag that does not end or has a malformed attribute.
    std::optional<XmlTag> next();

    /// All that is behind the last tag.
    std::string_view rest() const { return behind_; }

private:
    std::string_view left_, behind_;
};

}  // namespace kontur
