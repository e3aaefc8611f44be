// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/nifti_extensions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "kontur/base/printable.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/images/nifti_header.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr std::string_view kCdataBegin = "<![CDATA[", kCdataEnd = "]]>";
constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
    {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}}};

std::uint32_t number_at(std::span<const unsigned char, 4> bytes, bool big_endian) {
    std::uint32_t number = 0;
    for (std::size_t n = 0; n < 4; ++n) number = number << 8 | bytes[big_endian ? n : 3 - n];
    return number;
}

std::string without_entities(std::string_view text) {
    std::string plain;
    while (!text.empty()) {
        const auto entity =
            std::ranges::find_if(kEntities, [&](const auto& candidate) { return text.starts_with(candidate.first); });
        plain += entity == kEntities.end() ? text.front() : entity->second;
        text.remove_prefix(entity == kEntities.end() ? 1 : entity->first.size());
    }
    return plain;
}

/// What stands between the tags of a label.
std::string name_in(std::string_view content) {
    content = trimmed(content);
    std::string name;
    if (content.starts_with(kCdataBegin)) {
        content.remove_prefix(kCdataBegin.size());
        name = content.substr(0, content.find(kCdataEnd));
    } else {
        name = without_entities(content);
    }
    name = trimmed(name);
    return is_utf8(name) ? name : latin1_to_utf8(name);
}

std::string_view attribute(std::string_view tag, std::string_view key) {
    const std::string begin = fmt::format(" {}=\"", key);
    const std::size_t at = tag.find(begin);
    if (at == std::string_view::npos) return {};
    tag.remove_prefix(at + begin.size());
    return tag.substr(0, tag.find('"'));
}

std::optional<LabelName> label_in(std::string_view tag, std::string_view content) {
    const std::optional<std::int64_t> key = parse_integer(attribute(tag, "Key"));
    LabelName label{key.value_or(0), name_in(content)};
    if (label.label == 0 || label.name.empty()) return std::nullopt;
    constexpr std::array kLevels{"Red", "Green", "Blue"};
    for (std::size_t n = 0; n < kLevels.size(); ++n)
        label.color[n] = std::clamp(parse_number(attribute(tag, kLevels[n])).value_or(label.color[n]), 0.0, 1.0);
    return label;
}

std::vector<LabelName> labels_in(std::string_view table) {
    constexpr std::string_view kBegin = "<Label ", kEnd = "</Label>";
    std::vector<LabelName> labels;
    for (std::size_t at = table.find(kBegin); at != std::string_view::npos; at = table.find(kBegin, at + 1)) {
        const std::size_t tag_end = table.find('>', at), end = table.find(kEnd, at);
        if (tag_end == std::string_view::npos || end == std::string_view::npos || end < tag_end) continue;
        const auto label = label_in(table.substr(at, tag_end - at), table.substr(tag_end + 1, end - tag_end - 1));
        const auto is_same = [&](const LabelName& other) { return label && other.label == label->label; };
        if (label && std::ranges::none_of(labels, is_same)) labels.push_back(*label);
    }
    return labels;
}

}  // namespace

std::vector<NiftiExtension> read_nifti_extensions(const fs::path& path) {
    InputFile file(path);
    if (file.at_gzip()) file.inflate();
    std::array<unsigned char, 544> header{};
    if (file.read_some(header.data(), 4) < 4) return {};
    const NiftiKind kind = nifti_kind(std::span(header).first<4>());
    if (kind.version == 0) return {};
    const std::size_t header_bytes = nifti_header_bytes(kind.version) + 4;  // the last 4 tell of extensions
    if (file.read_some(header.data() + 4, header_bytes - 4) < header_bytes - 4 || header[header_bytes - 4] == 0) return {};
    const double left = parse_nifti_header(header, kind).vox_offset - static_cast<double>(header_bytes);
    if (!(left > 0)) return {};
    std::vector<NiftiExtension> extensions;
    auto bytes_left = static_cast<std::size_t>(std::min(left, static_cast<double>(kMostBytes)));
    std::array<unsigned char, 8> start{};
    while (bytes_left >= start.size() && file.read_some(start.data(), start.size()) == start.size()) {
        const std::size_t size = number_at(std::span(start).first<4>(), kind.big_endian);
        if (size < start.size() || size > bytes_left) break;
        std::string content(size - start.size(), '\0');
        if (file.read_some(content.data(), content.size()) < content.size()) break;
        extensions.push_back({number_at(std::span(start).last<4>(), kind.big_endian), std::move(content)});
        bytes_left -= size;
    }
    return extensions;
}

std::string to_bytes(const NiftiExtension& extension) {
    const auto size = static_cast<std::uint32_t>((8 + extension.content.size() + 15) / 16 * 16);
    std::string bytes;
    for (const std::uint32_t number : {size, extension.code})
        for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(number >> shift & 255);
    bytes += extension.content;
    bytes.resize(size, '\0');
    return bytes;
}

std::vector<LabelName> read_nifti_labels(const fs::path& path) {
    constexpr std::string_view kBegin = "<LabelTable>", kEnd = "</LabelTable>";
    for (const NiftiExtension& extension : read_nifti_extensions(path)) {
        const std::string_view text = extension.content;
        const std::size_t begin = text.find(kBegin), end = text.find(kEnd);
        if (extension.code == kNiftiCommentCode || begin == std::string_view::npos || end == std::string_view::npos)
            continue;
        if (end > begin) return labels_in(text.substr(begin, end - begin));
    }
    return {};
}

NiftiExtension label_table(const std::vector<LabelName>& labels) {
    std::string text =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><CaretExtension><VolumeInformation Index=\"0\"><LabelTable>";
    for (const LabelName& label : labels) {
        std::string name = label.name;
        for (std::size_t at = 0; (at = name.find(kCdataEnd)) != std::string::npos;) name.replace(at, 3, "]] >");
        text += fmt::format("<Label Key=\"{}\" Red=\"{:g}\" Green=\"{:g}\" Blue=\"{:g}\" Alpha=\"1\">{}{}{}</Label>",
                            label.label, label.color[0], label.color[1], label.color[2], kCdataBegin, name, kCdataEnd);
    }
    text +=
        "</LabelTable><StudyMetaDataLinkSet></StudyMetaDataLinkSet><VolumeType><![CDATA[Label]]></VolumeType>"
        "</VolumeInformation></CaretExtension>";
    return {kNiftiCaretCode, std::move(text)};
}

}  // namespace kontur
