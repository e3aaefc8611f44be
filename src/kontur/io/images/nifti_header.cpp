// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/nifti_header.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kontur/io/bytes/byte_order.h"

namespace kontur {
namespace {

class FieldReader {
public:
    FieldReader(std::span<const unsigned char> bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}

    template <typename Stored, typename Value>
    void field(std::size_t offset, Value& value) const {
        value = static_cast<Value>(load<Stored>(bytes_.data() + offset, big_endian_));
    }

private:
    std::span<const unsigned char> bytes_;
    bool big_endian_;
};

class FieldWriter {
public:
    explicit FieldWriter(std::span<unsigned char> bytes) : bytes_(bytes) {}

    template <typename Stored, typename Value>
    void field(std::size_t offset, const Value& value) const {
        store(static_cast<Stored>(value), /*big_endian=*/false, bytes_.data() + offset);
    }

private:
    std::span<unsigned char> bytes_;
};

/// Calls `fields.field<type on disk>(offset, value)` for every field of nifti1.h.
template <typename Header, typename Fields>
void visit_version_1(Header& header, const Fields& fields) {
    for (std::size_t n = 0; n < 8; ++n) {
        fields.template field<std::int16_t>(40 + 2 * n, header.dim[n]);
        fields.template field<float>(76 + 4 * n, header.pixdim[n]);
    }
    fields.template field<std::int16_t>(70, header.datatype);
    fields.template field<std::int16_t>(72, header.bits_per_voxel);
    fields.template field<float>(108, header.vox_offset);
    fields.template field<float>(112, header.slope);
    fields.template field<float>(116, header.intercept);
    fields.template field<std::uint8_t>(123, header.units);
    fields.template field<std::int16_t>(252, header.qform_code);
    fields.template field<std::int16_t>(254, header.sform_code);
    for (int n = 0; n < 3; ++n) {
        const auto row = static_cast<std::size_t>(n);
        fields.template field<float>(256 + 4 * row, header.quaternion[n]);
        fields.template field<float>(268 + 4 * row, header.qoffset[n]);
        for (std::size_t column = 0; column < 3; ++column)
            fields.template field<float>(280 + 16 * row + 4 * column, header.sform.linear[row][column]);
        fields.template field<float>(292 + 16 * row, header.sform.translation[n]);
    }
}

/// The same for nifti2.h.
template <typename Header, typename Fields>
void visit_version_2(Header& header, const Fields& fields) {
    for (std::size_t n = 0; n < 8; ++n) {
        fields.template field<std::int64_t>(16 + 8 * n, header.dim[n]);
        fields.template field<double>(104 + 8 * n, header.pixdim[n]);
    }
    fields.template field<std::int16_t>(12, header.datatype);
    fields.template field<std::int16_t>(14, header.bits_per_voxel);
    fields.template field<std::int64_t>(168, header.vox_offset);
    fields.template field<double>(176, header.slope);
    fields.template field<double>(184, header.intercept);
    fields.template field<std::int32_t>(344, header.qform_code);
    fields.template field<std::int32_t>(348, header.sform_code);
    for (int n = 0; n < 3; ++n) {
        const auto row = static_cast<std::size_t>(n);
        fields.template field<double>(352 + 8 * row, header.quaternion[n]);
        fields.template field<double>(376 + 8 * row, header.qoffset[n]);
        for (std::size_t column = 0; column < 3; ++column)
            fields.template field<double>(400 + 32 * row + 8 * column, header.sform.linear[row][column]);
        fields.template field<double>(424 + 32 * row, header.sform.translation[n]);
    }
    fields.template field<std::int32_t>(500, header.units);
}

constexpr std::size_t magic_offset(int version) { return version == 1 ? 344 : 4; }
constexpr std::size_t description_offset(int version) { return version == 1 ? 148 : 240; }

void copy_text(std::string_view text, std::size_t offset, std::vector<unsigned char>& bytes) {
    std::copy(text.begin(), text.end(), bytes.begin() + static_cast<std::ptrdiff_t>(offset));
}

/// Unit quaternion (a, b, c, d) with a >= 0 of a rotation with the given columns. The largest component is found from the
/// diagonal first, so that no small number is divided by.
std::array<double, 4> quaternion_of(const Vec3& x, const Vec3& y, const Vec3& z) {
    const std::array<double, 4> squares{1 + x.x + y.y + z.z, 1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z, 1 - x.x - y.y + z.z};
    const auto largest = std::max_element(squares.begin(), squares.end()) - squares.begin();
    const double s = 0.5 / std::sqrt(squares[static_cast<std::size_t>(largest)]), own = 0.25 / s;
    std::array<double, 4> q;
    if (largest == 0) q = {own, s * (y.z - z.y), s * (z.x - x.z), s * (x.y - y.x)};
    else if (largest == 1) q = {s * (y.z - z.y), own, s * (y.x + x.y), s * (z.x + x.z)};
    else if (largest == 2) q = {s * (z.x - x.z), s * (y.x + x.y), own, s * (z.y + y.z)};
    else q = {s * (x.y - y.x), s * (z.x + x.z), s * (z.y + y.z), own};
    if (q[0] < 0)
        for (double& component : q) component = -component;
    return q;
}

}  // namespace

NiftiKind nifti_kind(std::span<const unsigned char, 4> first_bytes) {
    for (const bool big_endian : {false, true})
        for (const int version : {1, 2})
            if (load<std::uint32_t>(first_bytes.data(), big_endian) == nifti_header_bytes(version))
                return {version, big_endian};
    return {};
}

std::string_view nifti_magic(std::span<const unsigned char> header, int version) {
    const auto* text = reinterpret_cast<const char*>(header.data()) + magic_offset(version);
    return {text, ::strnlen(text, 4)};
}

NiftiHeader parse_nifti_header(std::span<const unsigned char> bytes, const NiftiKind& kind) {
    NiftiHeader header;
    header.version = kind.version;
    const FieldReader fields(bytes, kind.big_endian);
    if (kind.version == 1) visit_version_1(header, fields);
    else visit_version_2(header, fields);
    return header;
}

std::vector<unsigned char> format_nifti_header(const NiftiHeader& header) {
    const std::size_t size = nifti_header_bytes(header.version);
    std::vector<unsigned char> bytes(size + 4);
    const FieldWriter fields(bytes);
    fields.field<std::int32_t>(0, size);
    if (header.version == 1) visit_version_1(header, fields);
    else visit_version_2(header, fields);
    copy_text(header.version == 1 ? "n+1" : std::string_view("n+2\0\r\n\032\n", 8), magic_offset(header.version), bytes);
    copy_text(std::string_view(header.description).substr(0, 79), description_offset(header.version), bytes);
    return bytes;
}

Affine3 qform_affine(const NiftiHeader& header) {
    Vec3 q = header.quaternion;
    double a_squared = 1 - dot(q, q);
    // Half a turn: rounding of the stored b, c, d must not become a rotation of its own, as in the NIfTI reference code.
    constexpr double kNoRealPart = 1e-7;
    if (a_squared < kNoRealPart) {
        q = normalized(q);
        a_squared = 0;
    }
    const double a = std::sqrt(a_squared), b = q.x, c = q.y, d = q.z;
    const double handedness = header.pixdim[0] < 0 ? -1 : 1;
    Affine3 affine;
    affine.set_column(0, header.pixdim[1] * Vec3{a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)});
    affine.set_column(1, header.pixdim[2] * Vec3{2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)});
    affine.set_column(
        2, header.pixdim[3] * handedness * Vec3{2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c});
    affine.translation = header.qoffset;
    return affine;
}

void set_qform(NiftiHeader& header, const Affine3& index_to_ras) {
    std::array<Vec3, 3> axes;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 column = index_to_ras.column(axis);
        header.pixdim[static_cast<std::size_t>(axis) + 1] = norm(column);
        axes[static_cast<std::size_t>(axis)] = normalized(column);
    }
    header.pixdim[0] = index_to_ras.determinant() < 0 ? -1 : 1;
    const auto q = quaternion_of(axes[0], axes[1], header.pixdim[0] * axes[2]);
    header.quaternion = {q[1], q[2], q[3]};
    header.qoffset = index_to_ras.translation;
}

}  // namespace kontur
