// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/nifti.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/bytes/deflate.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/geometry/affine_frame.h"
#include "kontur/io/images/image_files.h"
#include "kontur/io/images/nifti_extensions.h"
#include "kontur/io/images/nifti_header.h"
#include "kontur/io/images/transform_choice_error.h"
#include "kontur/io/images/voxel_stream.h"

namespace kontur {
namespace fs = std::filesystem;
namespace {

constexpr double kAgreementMm = 0.1;  ///< how far apart qform and sform may be and still mean the same
constexpr double kQformErrorMm = 0.01;
constexpr std::size_t kMaxDescriptionBytes = 72;  ///< of 79, after "kontur "

[[noreturn]] void fail_corrupt(const fs::path& path, const std::string& reason) {
    throw Error(ErrorKind::corrupt_file, path.string() + ": " + reason);
}

[[noreturn]] void fail_unsupported(const fs::path& path, const std::string& reason) {
    throw Error(ErrorKind::unsupported, path.string() + ": " + reason);
}

/// `in_pair`: the voxels are expected in a second file.
NiftiHeader read_header(InputFile& file, bool in_pair, bool& big_endian) {
    std::array<unsigned char, 540> bytes{};
    file.read(bytes.data(), 4);
    const NiftiKind kind = nifti_kind(std::span(bytes).first<4>());
    if (kind.version == 0) fail_corrupt(file.path(), "it is no NIfTI file (its first 4 bytes are no header size)");
    file.read(bytes.data() + 4, nifti_header_bytes(kind.version) - 4);
    const std::string_view magic = nifti_magic(bytes, kind.version);
    const bool is_one_file = magic == (kind.version == 1 ? "n+1" : "n+2");
    const bool is_pair = magic == (kind.version == 1 ? "ni1" : "ni2");
    if (in_pair && !is_pair && !is_one_file && kind.version == 1)
        fail_unsupported(
            file.path(),
            "it is Analyze 7.5, whose header tells neither left from right nor where the image lies; convert it to "
            "NIfTI with a program that knows");
    if (!is_pair && !is_one_file) fail_corrupt(file.path(), "it is no NIfTI file (wrong magic string)");
    if (is_pair != in_pair)
        fail_corrupt(file.path(), is_pair
                                      ? "it says that its voxels are in a second file; such files are named .hdr and .img"
                                      : "it says that its voxels are in the same file; such a file is named .nii");
    big_endian = kind.big_endian;
    return parse_nifti_header(bytes, kind);
}

VoxelType voxel_type(const NiftiHeader& header, const fs::path& path) {
    switch (header.datatype) {
        case 2:
            return VoxelType::uint8;
        case 4:
            return VoxelType::int16;
        case 8:
            return VoxelType::int32;
        case 16:
            return VoxelType::float32;
        case 64:
            return VoxelType::float64;
        case 256:
            return VoxelType::int8;
        case 512:
            return VoxelType::uint16;
        case 768:
            return VoxelType::uint32;
        case 1024:
            return VoxelType::int64;
        case 1280:
            return VoxelType::uint64;
        case 32:
        case 1792:
        case 2048:
            fail_unsupported(path, "its samples are complex numbers; only real ones are read, such as their magnitude");
        case 128:
        case 2304:
            fail_unsupported(path, "its samples are colours; only scalars are read, such as one channel");
        case 1:
            fail_unsupported(path, "its samples are single bits, which are not read; bytes are");
        case 1536:
            fail_unsupported(path, "its samples are 128-bit floats, which are not read; 64-bit ones are");
        default:
            fail_corrupt(path, "its datatype " + std::to_string(header.datatype) + " is not defined");
    }
}

/// Size of one axis, 1 for an axis beyond the file's number of axes.
std::int64_t axis_size(const NiftiHeader& header, std::size_t axis, const fs::path& path) {
    if (static_cast<std::int64_t>(axis) > header.dim[0]) return 1;
    if (header.dim[axis] < 1)
        fail_corrupt(path, "it declares " + std::to_string(header.dim[axis]) + " voxels along axis " + std::to_string(axis));
    return header.dim[axis];
}

/// Number of frames; more axes than that are refused.
std::int64_t frame_count(const NiftiHeader& header, const fs::path& path) {
    for (std::size_t axis = 5; axis <= 7; ++axis)
        if (const std::int64_t size = axis_size(header, axis, path); size != 1)
            fail_unsupported(path,
                             "it has " + std::to_string(size) + " values along axis " + std::to_string(axis) +
                                 "; only 3 axes of space and one of frames are read, so save one of them as an image first");
    return axis_size(header, 4, path);
}

double mm_per_unit(const NiftiHeader& header, const fs::path& path) {
    constexpr std::int64_t kSpaceBits = 7;
    switch (header.units & kSpaceBits) {
        case 0:  // unknown: millimetres by custom
        case 2:
            return 1;
        case 1:
            return 1000;
        case 3:
            return 0.001;
        default:
            fail_corrupt(path, "its unit of length " + std::to_string(header.units & kSpaceBits) + " is not defined");
    }
}

std::optional<double> seconds_per_unit(const NiftiHeader& header) {
    constexpr std::int64_t kTimeBits = 56;
    switch (header.units & kTimeBits) {
        case 8:
            return 1;
        case 16:
            return 1e-3;
        case 24:
            return 1e-6;
        default:
            return std::nullopt;
    }
}

Affine3 unoriented_affine(const NiftiHeader& header) {
    Affine3 affine;
    for (int axis = 0; axis < 3; ++axis) affine.linear[axis][axis] = header.pixdim[static_cast<std::size_t>(axis) + 1];
    return affine;
}

std::string millimetres(double value) {
    std::string text = std::to_string(value);
    return text.substr(0, text.size() - 3) + " mm";
}

/// Why a grid is none; "" for one.
std::string fault_of(const Grid& grid) {
    try {
        check_grid(grid);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

/// Where one of a file's two transforms is none, the user may choose the other.
void check_both(const Grid& by_sform, const Grid& by_qform, const NiftiHeader& header, const fs::path& path) {
    const std::string sform = fault_of(by_sform), qform = fault_of(by_qform);
    if (sform.empty() && !qform.empty())
        fail_corrupt(path, fmt::format("{} by its qform (pixdim {:g} {:g} {:g}); the option prefer sform reads it", qform,
                                       header.pixdim[1], header.pixdim[2], header.pixdim[3]));
    if (qform.empty() && !sform.empty())
        fail_corrupt(path, fmt::format("{} by its sform; the option prefer qform reads it", sform));
    if (!sform.empty()) fail_corrupt(path, sform);
}

/// The transform that counts, index to LPS in mm.
Affine3 chosen_affine(const NiftiHeader& header, const Index3& size, const fs::path& path, const ReadImageOptions& options) {
    const double unit = mm_per_unit(header, path);
    const auto in_lps_mm = [&](const Affine3& affine) { return ras_to_lps(scaled(affine, unit)); };
    const bool has_sform = header.sform_code > 0, has_qform = header.qform_code > 0;
    const Grid by_sform{size, in_lps_mm(header.sform)}, by_qform{size, in_lps_mm(qform_affine(header))};
    if (has_sform && has_qform && !options.prefer) {
        check_both(by_sform, by_qform, header, path);
        const double difference = corner_distance_mm(by_sform, by_qform);
        if (!(difference <= kAgreementMm))
            throw TransformChoiceError(
                path.string() + ": its sform and qform differ by " + millimetres(difference) +
                " at a corner (limit 0.1 mm); say which one counts with the option prefer (sform or qform)");
    }
    if (has_sform && has_qform && options.prefer == NiftiTransform::qform) return by_qform.index_to_mm;
    if (has_sform) return by_sform.index_to_mm;
    if (has_qform) return by_qform.index_to_mm;
    if (!options.allow_missing_geometry)
        fail_unsupported(path,
                         "it does not say how it lies in the patient (qform and sform codes are 0); "
                         "the option allow_missing_geometry reads it with axes R, A, S");
    return in_lps_mm(unoriented_affine(header));
}

void set_scaling(const NiftiHeader& header, const fs::path& path, VoxelEncoding& encoding) {
    // Slope 0 means "not scaled"; NaN is what some writers store for the same.
    if (header.slope == 0 || std::isnan(header.slope)) return;
    if (!std::isfinite(header.slope) || !std::isfinite(header.intercept))
        fail_corrupt(path, "its scl_slope or scl_inter is not finite");
    encoding.slope = header.slope;
    encoding.intercept = header.intercept;
}

void skip_to_voxels(InputFile& file, const NiftiHeader& header) {
    const auto header_bytes = static_cast<double>(nifti_header_bytes(header.version));
    // The upper limit keeps the conversion to an integer defined.
    if (!(header.vox_offset >= header_bytes + 4 && header.vox_offset < 1e15))
        fail_corrupt(file.path(), "its voxels start at byte " + std::to_string(header.vox_offset) + ", within its header");
    file.skip(static_cast<std::uint64_t>(header.vox_offset - header_bytes));
}

/// At the first voxel of a pair's second file.
InputFile open_voxels(const fs::path& path, const NiftiHeader& header) {
    InputFile file(path);
    if (file.at_gzip()) file.inflate();
    if (!(header.vox_offset >= 0 && header.vox_offset < 1e15))
        fail_corrupt(path, "its voxels start at byte " + std::to_string(header.vox_offset));
    file.skip(static_cast<std::uint64_t>(header.vox_offset));
    return file;
}

OpenImage open_nifti(const fs::path& path, const ReadImageOptions& options) {
    const std::optional<ImagePair> pair = image_pair(path);
    InputFile file(pair ? pair->header : path);
    if (file.at_gzip()) file.inflate();
    VoxelEncoding encoding;
    const NiftiHeader header = read_header(file, pair.has_value(), encoding.big_endian);
    if (header.dim[0] < 1 || header.dim[0] > 7)
        fail_corrupt(path, "it declares " + std::to_string(header.dim[0]) + " axes; 1 to 7 are possible");
    encoding.type = voxel_type(header, path);
    encoding.components = frame_count(header, path);
    set_scaling(header, path, encoding);
    Grid grid{{axis_size(header, 1, path), axis_size(header, 2, path), axis_size(header, 3, path)}, {}};
    grid.index_to_mm = chosen_affine(header, grid.size, path, options);
    check_header_grid(grid, path);
    if (pair) return {grid, encoding, open_voxels(pair->voxels, header)};
    skip_to_voxels(file, header);
    return {grid, encoding, std::move(file)};
}

template <typename Value>
constexpr std::int64_t datatype_code() {
    if constexpr (std::is_same_v<Value, std::uint8_t>) return 2;
    else if constexpr (std::is_same_v<Value, std::int16_t>) return 4;
    else if constexpr (std::is_same_v<Value, std::uint16_t>) return 512;
    else if constexpr (std::is_same_v<Value, std::int32_t>) return 8;
    else return 16;
}

/// Whether the qform, at the precision of the file, says the same as the sform.
bool qform_suffices(const NiftiHeader& header, const Index3& size) {
    const auto bytes = format_nifti_header(header);
    const NiftiHeader stored = parse_nifti_header(bytes, {header.version, false});
    return corner_distance_mm({size, stored.sform}, {size, qform_affine(stored)}) <= kQformErrorMm;
}

NiftiHeader header_for(const Grid& grid) {
    constexpr std::int64_t kMaxVersion1Size = 32767;
    NiftiHeader header;
    header.version = std::max({grid.size.i, grid.size.j, grid.size.k}) > kMaxVersion1Size ? 2 : 1;
    header.dim = {3, grid.size.i, grid.size.j, grid.size.k, 1, 1, 1, 1};
    header.vox_offset = static_cast<double>(nifti_header_bytes(header.version) + 4);
    header.slope = 1;
    header.units = 2;
    header.sform_code = header.qform_code = 1;
    header.sform = lps_to_ras(grid.index_to_mm);
    header.description = "kontur " KONTUR_VERSION;
    set_qform(header, header.sform);
    if (!qform_suffices(header, grid.size)) {
        header.qform_code = 0;
        header.quaternion = header.qoffset = {};
    }
    return header;
}

/// The table of labels first: TotalSegmentator reads the first extension alone.
std::string extensions_of(const ImageView& image) {
    std::string bytes;
    if (!image.labels.empty()) bytes += to_bytes(label_table(image.labels));
    if (image.provenance.empty()) return bytes;
    NiftiExtension comment{kNiftiCommentCode, "kontur\n"};
    for (const auto& [name, value] : image.provenance) comment.content += fmt::format("{}: {}\n", name, value);
    return bytes + to_bytes(comment);
}

}  // namespace

Image read_nifti(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    return read_voxels(open_nifti(path, options), options, work);
}

Grid read_nifti_grid(const fs::path& path, const ReadImageOptions& options) { return open_nifti(path, options).grid; }

ImageFrames read_nifti_frames(const fs::path& path) {
    const std::optional<ImagePair> pair = image_pair(path);
    InputFile file(pair ? pair->header : path);
    if (file.at_gzip()) file.inflate();
    bool big_endian = false;
    const NiftiHeader header = read_header(file, pair.has_value(), big_endian);
    ImageFrames frames{frame_count(header, path), {}};
    const std::optional<double> unit = seconds_per_unit(header);
    if (const double step = header.pixdim[4]; unit && std::isfinite(step) && step > 0) frames.step_s = *unit * step;
    return frames;
}

void write_nifti(const fs::path& path, const ImageView& image, const ImageFrames& frames) {
    check_grid(image.grid);
    NiftiHeader header = header_for(image.grid);
    if (frames.count > 1) {
        header.dim[0] = 4;
        header.dim[4] = frames.count;
        if (frames.step_s) {
            constexpr std::int64_t kSeconds = 8;
            header.pixdim[4] = *frames.step_s;
            header.units |= kSeconds;
        }
    }
    std::visit(
        [&]<typename Value>(std::span<const Value>) {
            header.datatype = datatype_code<Value>();
            header.bits_per_voxel = 8 * sizeof(Value);
        },
        image.samples);
    const std::string extension = extensions_of(image);
    header.vox_offset += static_cast<double>(extension.size());
    if (!image.provenance.empty()) header.description = "kontur " + short_text(image.provenance, kMaxDescriptionBytes);
    auto bytes = format_nifti_header(header);
    if (!extension.empty()) bytes[nifti_header_bytes(header.version)] = 1;
    bytes.insert(bytes.end(), extension.begin(), extension.end());
    write_file_atomically(path, [&](AtomicFile& file) {
        if (lower_case(path.extension().string()) == ".gz") {
            Deflater deflater(
                DeflateFormat::gzip, [&](const void* data, std::size_t count) { file.write(data, count); },
                deflate_mode(image));
            deflater.write(std::as_bytes(std::span(bytes)));
            deflater.write(bytes_of(image));
            deflater.finish();
        } else {
            file.write(bytes.data(), bytes.size());
            const auto voxels = bytes_of(image);
            file.write(voxels.data(), voxels.size());
        }
    });
}

}  // namespace kontur
