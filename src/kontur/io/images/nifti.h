// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kontur/base/work.h"
#include "kontur/io/images/frames.h"
#include "kontur/io/images/image_view.h"
#include "kontur/io/images/read_image_options.h"

namespace kontur {

/// Reads NIfTI-1 and NIfTI-2 in one file (.nii, .nii.gz) or a pair of them (.hdr and .img, one of which is named; compressed
/// ones, too), both byte orders, every real scalar type, with scl_slope and
/// scl_inter applied and its RAS frame turned into LPS, in metres, millimetres or micrometres.
///
/// The sform counts if its code is above 0, else the qform. When both are there and differ by more than 0.1 mm at a corner
/// of the grid, the file is refused unless `prefer` names one; when neither is, unless `allow_missing_geometry`. Shear is
/// kept. Throws Error(corrupt_file) for contradictions, Error(unsupported) for variants (complex and colour samples, more
/// than four axes) and Analyze 7.5, whose header tells neither left from right nor where the image lies; Error(too_large).
/// Source: NIfTI-1 and NIfTI-2 headers (nifti1.h, nifti2.h of the NIfTI Data Format Working Group).
Image read_nifti(const std::filesystem::path& path, const ReadImageOptions& options = {}, const Work& work = {});

/// The geometry alone, from the header.
Grid read_nifti_grid(const std::filesystem::path& path, const ReadImageOptions& options = {});

/// Frames and the time between them, where the header has both the time and its unit.
ImageFrames read_nifti_frames(const std::filesystem::path& path);

/// Writes NIfTI-1, or NIfTI-2 when a size exceeds 32767; compressed when the name ends with .gz, the same bytes each time.
/// The sform holds the full affine; the qform is written beside it (both with code 1) only when it can express the same,
/// that is without shear. Sample type as in memory. NIfTI-1 keeps the affine in single precision.
/// Of several `frames` the image has the samples of one after the other, on one grid.
void write_nifti(const std::filesystem::path& path, const ImageView& image, const ImageFrames& frames = {});

}  // namespace kontur
