// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/read_provenance.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/printable.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/bytes/json_file.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/bytes/xml_tags.h"
#include "kontur/io/dicom/dicom_object.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/images/mgh.h"
#include "kontur/io/images/nifti_extensions.h"
#include "kontur/io/images/nrrd_header.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 16;  ///< of text; what kontur writes is far shorter
constexpr std::string_view kShortened = "shortened";

bool is_word(std::string_view name) {
    const auto belongs = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return !name.empty() && std::all_of(name.begin(), name.end(), belongs);
}

/// "NAME: VALUE" as an entry; nullopt for any other text.
std::optional<std::pair<std::string, std::string>> entry_of(std::string_view text) {
    const std::size_t colon = text.find(": ");
    if (colon == std::string_view::npos || !is_word(text.substr(0, colon))) return std::nullopt;
    return std::pair{std::string(text.substr(0, colon)), std::string(text.substr(colon + 2))};
}

/// The lines that begin so and go on "NAME: VALUE".
Provenance from_lines(std::string_view text, std::string_view begin) {
    Provenance found;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        if (!line.starts_with(begin)) continue;
        if (auto entry = entry_of(line.substr(begin.size()))) found.push_back(std::move(*entry));
    }
    return found;
}

Provenance from_shortened(std::string_view text) {
    if (text.empty()) return {};
    return {{std::string(kShortened), std::string(text)}};
}

std::string head_of(const fs::path& path, std::size_t most_bytes) {
    InputFile file(path);
    std::string text(most_bytes, '\0');
    text.resize(file.read_some(text.data(), text.size()));
    return text;
}

Provenance from_json(const fs::path& path) {
    const nlohmann::json document = read_json_file(path);
    Provenance found;
    if (!document.is_object()) return found;
    for (const char* key : {"provenance", "kontur"})
        if (const auto entries = document.find(key); entries != document.end() && entries->is_object())
            for (const auto& [name, value] : entries->items())
                if (value.is_string()) found.emplace_back(name, value.get<std::string>());
    return found;
}

/// "kontur VERSION SPACE=LPS UNIT=mm TEXT".
Provenance from_title(std::string_view title) {
    constexpr std::string_view kBegin = "kontur ", kUnit = "UNIT=mm ";
    const std::size_t unit = title.find(kUnit);
    if (!title.starts_with(kBegin) || unit == std::string_view::npos) return {};
    return from_shortened(title.substr(unit + kUnit.size()));
}

Provenance from_stl(const fs::path& path) {
    constexpr std::size_t kTitleBytes = 80;
    const std::string head = head_of(path, kTitleBytes);
    return from_title(std::string_view(head).substr(0, head.find('\0')));
}

/// The second line.
Provenance from_vtk(const fs::path& path) {
    const std::string head = head_of(path, kMostHeaderBytes);
    const std::size_t begin = std::min(head.find('\n'), head.size() - 1) + 1;
    return from_title(std::string_view(head).substr(begin, head.find('\n', begin) - begin));
}

/// Fields whose texts stand there as the numbers of their characters.
Provenance from_vtp(const fs::path& path) {
    constexpr std::string_view kBegin = "kontur_";
    const std::string head = head_of(path, kMostHeaderBytes);
    XmlTags tags(std::string_view(head).substr(0, head.find("</FieldData>")));
    Provenance found;
    while (const auto tag = tags.next()) {
        const std::string_view name = tag->attribute("Name");
        if (!tag->opens || !name.starts_with(kBegin)) continue;
        std::string text;
        for (const std::string_view code : words(tag->text))
            if (const auto number = parse_integer(code); number && *number > 0 && *number < 256)
                text += static_cast<char>(*number);
        found.emplace_back(name.substr(kBegin.size()), text);
    }
    return found;
}

Provenance from_metaimage(const fs::path& path) {
    constexpr std::string_view kBegin = "kontur ";
    InputFile file(path);
    while (const auto line = file.read_line(kMostHeaderBytes)) {
        const std::size_t equals = line->find('=');
        const std::string_view key = trimmed(std::string_view(*line).substr(0, equals));
        if (equals == std::string::npos || key == "ElementDataFile") break;
        const std::string_view value = trimmed(std::string_view(*line).substr(equals + 1));
        if (key == "Comment" && value.starts_with(kBegin)) return from_shortened(value.substr(kBegin.size()));
    }
    return {};
}

Provenance from_nrrd(const fs::path& path) {
    constexpr std::string_view kBegin = "kontur_";
    InputFile file(path);
    Provenance found;
    for (const auto& [name, value] : read_nrrd_header(file).keys)
        if (name.starts_with(kBegin)) found.emplace_back(name.substr(kBegin.size()), value);
    return found;
}

Provenance from_nifti(const fs::path& path) {
    constexpr std::string_view kBegin = "kontur\n";
    for (const NiftiExtension& extension : read_nifti_extensions(path)) {
        const std::string_view text = extension.content;
        if (extension.code == kNiftiCommentCode && text.starts_with(kBegin))
            return from_lines(text.substr(0, text.find('\0')), "");
    }
    return {};
}

/// Cuts "NAME: VALUE; NAME: VALUE", in whose values each ';' is doubled.
std::vector<std::string> parts_of_description(std::string_view text) {
    std::vector<std::string> parts(1);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string_view two = text.substr(i, 2);
        if (two == "; ") parts.emplace_back();
        else parts.back() += text[i];
        if (two == "; " || two == ";;") ++i;
    }
    return parts;
}

/// kontur's contribution. What names nothing belongs to the value before it: earlier files do not double their ';'.
Provenance from_dicom(const fs::path& path) {
    Provenance found;
    for (const std::string& description : kontur_contributions(path)) {
        for (const std::string& part : parts_of_description(description)) {
            if (auto entry = entry_of(part)) found.push_back(std::move(*entry));
            else if (!found.empty()) found.back().second += "; " + part;
        }
    }
    return found;
}

Provenance as_written(const fs::path& path) {
    const std::string name = lower_case(path.filename().string());
    const auto has = [&](std::string_view extension) { return name.ends_with(extension); };
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) return {};
    if (has(".json")) return from_json(path);
    if (has(".ply")) return from_lines(head_of(path, kMostHeaderBytes), "comment kontur ");
    if (has(".obj")) return from_lines(head_of(path, kMostHeaderBytes), "# kontur ");
    if (has(".stl")) return from_stl(path);
    if (has(".vtk")) return from_vtk(path);
    if (has(".vtp")) return from_vtp(path);
    if (has(".mha") || has(".mhd")) return from_metaimage(path);
    if (has(".nrrd") || has(".nhdr")) return from_nrrd(path);
    if (has(".mgz") || has(".mgh") || has(".mgh.gz")) return read_mgh_provenance(path);
    if (looks_like_dicom(path)) return from_dicom(path);
    if (has(".nii") || has(".nii.gz")) return from_nifti(path);
    return {};
}

}  // namespace

Provenance read_provenance(const fs::path& path) {
    Provenance provenance = as_written(path);
    std::erase_if(provenance, [](const auto& entry) { return !is_word(entry.first); });
    for (auto& [name, value] : provenance) value = printable_utf8(value);
    return provenance;
}

}  // namespace kontur
