// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// The fields of a NIfTI header that kontur uses, for versions 1 and 2. Internal to io. In the file's own units and RAS.
struct NiftiHeader {
    int version = 1;
    std::array<std::int64_t, 8> dim{};
    std::int64_t datatype = 0;
    std::int64_t bits_per_voxel = 0;
    std::array<double, 8> pixdim{};  ///< [0] is the qform's handedness, 1 or -1
    double vox_offset = 0;
    double slope = 0, intercept = 0;
    std::int64_t units = 0;  ///< xyzt_units
    std::int64_t qform_code = 0, sform_code = 0;
    Vec3 quaternion;  ///< b, c, d
    Vec3 qoffset;
    Affine3 sform;
    std::string description;  ///< at most 79 bytes; written, not read
};

/// Bytes of a header, 0 for an unknown version.
constexpr std::size_t nifti_header_bytes(int version) { return version == 1 ? 348 : version == 2 ? 540 : 0; }

/// Where a header starts says what it is: its own size, in the file's byte order. Version 0: no NIfTI header.
struct NiftiKind {
    int version = 0;
    bool big_endian = false;
};
NiftiKind nifti_kind(std::span<const unsigned char, 4> first_bytes);

/// The magic string, such as "n+1" for voxels in the same file.
std::string_view nifti_magic(std::span<const unsigned char> header, int version);

/// `bytes` holds a whole header.
NiftiHeader parse_nifti_header(std::span<const unsigned char> bytes, const NiftiKind& kind);

/// Little-endian, followed by 4 bytes that say "no extensions".
std::vector<unsigned char> format_nifti_header(const NiftiHeader& header);

/// Index to RAS by the quaternion, in the file's units.
Affine3 qform_affine(const NiftiHeader& header);

/// Sets quaternion, offset and pixdim to the rotation, origin and spacing of `index_to_ras`, whose axes must be orthogonal.
void set_qform(NiftiHeader& header, const Affine3& index_to_ras);

}  // namespace kontur
