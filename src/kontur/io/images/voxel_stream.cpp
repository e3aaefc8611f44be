// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/voxel_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/base/number_from_chars.h"
#include "kontur/io/images/frame_choice_error.h"

namespace kontur {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

/// Calls `use` with a zero of the C++ type.
template <typename Use>
decltype(auto) with_type(VoxelType type, const Use& use) {
    switch (type) {
        case VoxelType::uint8:
            return use(std::uint8_t{});
        case VoxelType::int8:
            return use(std::int8_t{});
        case VoxelType::uint16:
            return use(std::uint16_t{});
        case VoxelType::int16:
            return use(std::int16_t{});
        case VoxelType::uint32:
            return use(std::uint32_t{});
        case VoxelType::int32:
            return use(std::int32_t{});
        case VoxelType::uint64:
            return use(std::uint64_t{});
        case VoxelType::int64:
            return use(std::int64_t{});
        case VoxelType::float32:
            return use(float{});
        default:
            return use(double{});
    }
}

template <typename Value>
void swap_bytes(std::vector<Value>& values) {
    for (Value& value : values) {
        unsigned char bytes[sizeof(Value)];
        std::memcpy(bytes, &value, sizeof(Value));
        std::reverse(bytes, bytes + sizeof(Value));
        std::memcpy(&value, bytes, sizeof(Value));
    }
}

void report(const Work& work, std::size_t done, std::size_t voxels) {
    work.report("read voxels", static_cast<double>(done) / static_cast<double>(voxels));
}

/// The `component`-th of every `components` interleaved values.
template <typename Value>
std::vector<Value> read_interleaved(InputFile& data, std::size_t components, std::size_t component, std::size_t voxels,
                                    const Work& work) {
    const std::size_t chunk = std::max<std::size_t>(1, kChunkBytes / (components * sizeof(Value)));
    std::vector<Value> buffer(std::min(chunk, voxels) * components);
    std::vector<Value> values;
    values.reserve(voxels);
    while (values.size() < voxels) {
        const std::size_t count = std::min(chunk, voxels - values.size());
        report(work, values.size(), voxels);
        data.read(buffer.data(), count * components * sizeof(Value));
        for (std::size_t n = 0; n < count; ++n) values.push_back(buffer[n * components + component]);
    }
    return values;
}

/// The vector grows as the values arrive: memory is reserved but not touched, so compressed data that claim gigabytes and
/// hold little take no more than they hold.
template <typename Value>
std::vector<Value> read_plain(InputFile& data, std::size_t voxels, const Work& work) {
    constexpr std::size_t kChunk = (std::size_t{1} << 22) / sizeof(Value);
    std::vector<Value> values;
    values.reserve(voxels);
    while (values.size() < voxels) {
        const std::size_t begin = values.size(), count = std::min(kChunk, voxels - begin);
        report(work, begin, voxels);
        values.resize(begin + count);
        data.read(values.data() + begin, count * sizeof(Value));
    }
    return values;
}

template <typename Value>
std::vector<Value> read_binary(InputFile& data, const VoxelEncoding& encoding, std::size_t voxels, std::size_t component,
                               const Work& work) {
    std::vector<Value> values;
    const auto components = static_cast<std::size_t>(encoding.components);
    const std::uint64_t volume_bytes = voxels * sizeof(Value);
    if (encoding.interleaved && components > 1) {
        values = read_interleaved<Value>(data, components, component, voxels, work);
    } else {
        data.skip(component * volume_bytes);
        values = read_plain<Value>(data, voxels, work);
        data.skip((components - 1 - component) * volume_bytes);
    }
    if (encoding.big_endian != (std::endian::native == std::endian::big)) swap_bytes(values);
    return values;
}

/// Numbers in a text, one after the other.
class NumberReader {
public:
    explicit NumberReader(InputFile& data) : data_(data) {}

    template <typename Value>
    Value next() {
        const std::string token = next_token();
        Value value{};
        const char* begin = token.data() + (token.starts_with('+') ? 1 : 0);
        const auto [end, error] = number_from_chars(begin, token.data() + token.size(), value);
        if (error != std::errc{} || end != token.data() + token.size())
            fail("\"" + token + "\" among its voxels is no number of the declared type");
        return value;
    }

    void check_end() {
        if (const std::string token = next_token(); !token.empty())
            fail("\"" + token + "\" follows the last of its declared voxels");
    }

private:
    /// Empty at the end of the text.
    std::string next_token() {
        constexpr std::size_t kMaxLength = 64, kShown = 16;
        std::string token;
        for (char c; next_character(c);) {
            const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',';
            if (blank && !token.empty()) break;
            if (!blank) token += c;
            if (token.size() > kMaxLength)
                fail("the number \"" + token.substr(0, kShown) + "...\" among its voxels has more than " +
                     std::to_string(kMaxLength) + " characters");
        }
        return token;
    }

    [[noreturn]] void fail(const std::string& reason) const {
        throw Error(ErrorKind::corrupt_file, data_.path().string() + ": " + reason);
    }

    bool next_character(char& c) {
        if (position_ == buffer_.size()) {
            buffer_.resize(kChunkBytes);
            buffer_.resize(data_.read_some(buffer_.data(), buffer_.size()));
            position_ = 0;
            if (buffer_.empty()) return false;
        }
        c = buffer_[position_++];
        return true;
    }

    InputFile& data_;
    std::string buffer_;
    std::size_t position_ = 0;
};

template <typename Value>
std::vector<Value> read_text(InputFile& data, const VoxelEncoding& encoding, std::size_t voxels, std::size_t component) {
    std::vector<Value> values(voxels);
    NumberReader numbers(data);
    const auto components = static_cast<std::size_t>(encoding.components);
    for (std::size_t n = 0; n < voxels * components; ++n) {
        const std::size_t this_component = encoding.interleaved ? n % components : n / voxels;
        const std::size_t voxel = encoding.interleaved ? n / components : n % voxels;
        const auto value = numbers.next<Value>();
        if (this_component == component) values[voxel] = value;
    }
    numbers.check_end();
    return values;
}

template <typename To, typename From, typename Convert>
Image::Samples convert(const std::vector<From>& values, const Convert& function) {
    std::vector<To> converted(values.size());
    std::transform(values.begin(), values.end(), converted.begin(), [&](From v) { return static_cast<To>(function(v)); });
    return converted;
}

/// Largest magnitude up to which `double` holds every integer.
constexpr double kExactIntegers = 9007199254740992.0;

/// Integers that a float does not hold exactly would merge with their neighbours; they may be labels.
template <typename Value, typename Rescaled>
void check_exact_in_float(const std::vector<Value>& values, const Rescaled& rescaled) {
    const auto is_exact = [](double v) {
        return std::abs(v) < kExactIntegers && static_cast<double>(static_cast<float>(v)) == v;
    };
    for (const Value value : values)
        if (const double v = rescaled(value); !is_exact(v))
            throw Error(ErrorKind::unsupported,
                        fmt::format("the voxel value {:.0f} is beyond 32-bit integers, and a float does not hold it "
                                    "exactly; save the image with smaller integers first",
                                    v));
}

/// Samples of slope * value + intercept, which are integers, in the narrowest type for their range.
template <typename Value>
Image::Samples narrowest_integers(std::vector<Value>&& values, double slope, double intercept) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const auto rescaled = [=](Value v) { return slope * static_cast<double>(v) + intercept; };
    const auto [from, to] = std::minmax({rescaled(*low), rescaled(*high)});
    const auto fits = [&, from = from, to = to](auto type) {
        using Limits = std::numeric_limits<decltype(type)>;
        return from >= static_cast<double>(Limits::lowest()) && to <= static_cast<double>(Limits::max());
    };
    if (fits(std::uint8_t{})) return convert<std::uint8_t>(values, rescaled);
    if (fits(std::int16_t{})) return convert<std::int16_t>(values, rescaled);
    if (fits(std::uint16_t{})) return convert<std::uint16_t>(values, rescaled);
    if (fits(std::int32_t{})) return convert<std::int32_t>(values, rescaled);
    check_exact_in_float(values, rescaled);
    return convert<float>(values, rescaled);
}

template <typename Value>
Image::Samples to_samples(std::vector<Value>&& values, double slope, double intercept) {
    constexpr bool kIsSampleType = std::is_same_v<Value, std::uint8_t> || std::is_same_v<Value, std::int16_t> ||
                                   std::is_same_v<Value, std::uint16_t> || std::is_same_v<Value, float>;
    const bool unscaled = slope == 1 && intercept == 0;
    if constexpr (kIsSampleType)
        if (unscaled) return std::move(values);
    if constexpr (std::is_integral_v<Value>) {
        const auto is_integer = [](double v) { return std::trunc(v) == v && std::abs(v) < kExactIntegers; };
        if (is_integer(slope) && is_integer(intercept)) return narrowest_integers(std::move(values), slope, intercept);
    }
    return convert<float>(values, [=](Value v) { return slope * static_cast<double>(v) + intercept; });
}

std::int64_t chosen_component(const OpenImage& image, const std::optional<std::int64_t>& frame) {
    const std::int64_t count = image.encoding.components;
    const std::string name = image.data.path().string();
    if (!frame && count > 1)
        throw FrameChoiceError(name + " has " + std::to_string(count) + " frames; choose one with the option frame (1 to " +
                                   std::to_string(count) + ")",
                               count);
    if (frame && (*frame < 1 || *frame > count))
        throw Error(ErrorKind::invalid_input, "frame " + std::to_string(*frame) + " of " + name +
                                                  " was asked for, but it has frames 1 to " + std::to_string(count));
    return frame.value_or(1) - 1;
}

}  // namespace

std::size_t byte_size(VoxelType type) noexcept {
    return with_type(type, [](auto zero) { return sizeof(zero); });
}

std::uint64_t declared_bytes(const OpenImage& image) {
    const auto voxels = static_cast<std::uint64_t>(image.grid.voxel_count());
    const auto components = static_cast<std::uint64_t>(image.encoding.components);
    // Text needs a digit and a blank for each number, but the last.
    const std::uint64_t each = image.encoding.text ? 2 : byte_size(image.encoding.type);
    std::uint64_t values = 0, bytes = 0;
    if (__builtin_mul_overflow(voxels, components, &values) || __builtin_mul_overflow(values, each, &bytes))
        throw Error(ErrorKind::corrupt_file, image.data.path().string() + ": its header declares " + std::to_string(voxels) +
                                                 " voxels in " + std::to_string(components) + " frames");
    return image.encoding.text ? bytes - 1 : bytes;
}

void note_bytes_left(const OpenImage& image, const ReadImageOptions& options) {
    const std::uint64_t declared = declared_bytes(image), held = image.data.stored_bytes_left();
    if (options.on_note && held > declared)
        options.on_note(fmt::format("{}: its header declares {} bytes of voxels, and {} are there; the rest is left out",
                                    image.data.path().string(), declared, held));
}

void check_header_grid(const Grid& grid, const std::filesystem::path& path) {
    try {
        check_grid(grid);
    } catch (const Error& error) {
        throw Error(ErrorKind::corrupt_file, path.string() + ": " + error.what());
    }
}

Image read_voxels(OpenImage&& image, const ReadImageOptions& options, const Work& work) {
    const auto component = static_cast<std::size_t>(chosen_component(image, options.frame));
    const std::int64_t count = image.grid.voxel_count();
    if (count > options.max_voxels)
        throw Error(ErrorKind::too_large, image.data.path().string() + " has " + std::to_string(count) +
                                              " voxels; at most " + std::to_string(options.max_voxels) +
                                              " are read, so crop it or resample it first");
    image.data.expect(declared_bytes(image));
    const auto voxels = static_cast<std::size_t>(count);
    return with_type(image.encoding.type, [&](auto zero) {
        using Value = decltype(zero);
        const VoxelEncoding& encoding = image.encoding;
        auto values = encoding.text ? read_text<Value>(image.data, encoding, voxels, component)
                                    : read_binary<Value>(image.data, encoding, voxels, component, work);
        image.data.finish();
        try {
            return Image{image.grid, to_samples(std::move(values), encoding.slope, encoding.intercept)};
        } catch (const Error& error) {
            throw error.with_context(image.data.path().string());
        }
    });
}

}  // namespace kontur
