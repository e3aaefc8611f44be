// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/image.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/io/image_view.h"
#include "kontur/io/nifti.h"

namespace kontur {
namespace fs = std::filesystem;
namespace {

enum class Format { unknown, nifti };

Format format_by_name(const fs::path& path) {
    std::string name = path.filename().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name.ends_with(".nii") || name.ends_with(".nii.gz")) return Format::nifti;
    return Format::unknown;
}

[[noreturn]] void refuse_name(const fs::path& path) {
    throw Error(ErrorKind::unsupported, path.string() + " has no known image format; known are .nii and .nii.gz");
}

Format readable_format(const fs::path& path) {
    const Format format = format_by_name(path);
    if (format == Format::unknown) refuse_name(path);
    return format;
}

std::string list_of(const std::map<std::int64_t, std::int64_t>& labels) {
    constexpr std::size_t kMaxListed = 20;
    std::string list;
    std::size_t listed = 0;
    for (const auto& [label, count] : labels) {
        if (++listed > kMaxListed) return list + " and " + std::to_string(labels.size() - kMaxListed) + " more";
        list += (list.empty() ? "" : ", ") + std::to_string(label);
    }
    return list.empty() ? "none" : list;
}

std::map<std::int64_t, std::int64_t> labels_of(const Image& image, const fs::path& path) {
    try {
        return count_labels(image);
    } catch (const Error& error) {
        throw error.with_context(path.string());
    }
}

template <typename Value>
std::vector<Value> with_value_inside(const Mask& mask, std::int64_t value) {
    std::vector<Value> values(mask.values.size());
    std::transform(mask.values.begin(), mask.values.end(), values.begin(),
                   [inside = static_cast<Value>(value)](std::uint8_t v) { return v ? inside : Value{0}; });
    return values;
}

void check_label_value(std::int64_t value) {
    constexpr std::int64_t kMaxLabel = 65535;
    if (value < 1 || value > kMaxLabel)
        throw Error(ErrorKind::invalid_input, "label value " + std::to_string(value) + " cannot be written; 1 to " +
                                                  std::to_string(kMaxLabel) + " can");
}

void write(const fs::path& path, const ImageView& image) {
    check_image_name(path);
    write_nifti(path, image);
}

}  // namespace

void check_image_name(const fs::path& path) {
    if (format_by_name(path) == Format::unknown) refuse_name(path);
}

Image read_image(const fs::path& path, const ReadImageOptions& options) {
    readable_format(path);
    return read_nifti(path, options);
}

Grid read_grid(const fs::path& path, const ReadImageOptions& options) {
    readable_format(path);
    return read_nifti_grid(path, options);
}

Mask read_mask(const fs::path& path, std::optional<std::int64_t> label, const ReadImageOptions& options) {
    const Image image = read_image(path, options);
    const auto labels = labels_of(image, path);
    if (!label && labels.size() > 1)
        throw Error(ErrorKind::invalid_input, path.string() + " has " + std::to_string(labels.size()) +
                                                  " labels; choose one of " + list_of(labels) + " with the option label");
    if (label && !labels.contains(*label))
        throw Error(ErrorKind::invalid_input,
                    path.string() + " has no label " + std::to_string(*label) + "; its labels are " + list_of(labels));
    return label ? select_label(image, static_cast<double>(*label)) : select_nonzero(image);
}

void write_mask(const fs::path& path, const Mask& mask, const WriteMaskOptions& options) {
    check_label_value(options.label_value);
    if (options.label_value == 1) write(path, mask);
    else if (options.label_value <= 255)
        write(path, Image{mask.grid, with_value_inside<std::uint8_t>(mask, options.label_value)});
    else write(path, Image{mask.grid, with_value_inside<std::uint16_t>(mask, options.label_value)});
}

void write_image(const fs::path& path, const Image& image) { write(path, image); }

}  // namespace kontur
