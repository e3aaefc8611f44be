// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kontur/base/work.h"
#include "kontur/io/images/read_image_options.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Reads GIPL (Guy's Image Processing Lab; .gipl, .gipl.gz), big-endian: integers of 8, 16 and 32 bits, floats of 32 and 64,
/// binary images a byte a voxel, frames one behind the other. The format has no agreed way to say how its axes lie in the
/// patient, and programs that write it lose that: a file is refused unless `allow_missing_geometry`, which reads it as ITK
/// and ITK-SNAP do, along L, P and S with its spacing and its origin the first voxel's place. Throws Error(corrupt_file),
/// Error(unsupported) for complex or rescaled samples, Error(too_large).
/// Source: the fields of the header as ITK's reader and writer use them (itkGiplImageIO).
Image read_gipl(const std::filesystem::path& path, const ReadImageOptions& options = {}, const Work& work = {});

/// The geometry alone, from the header.
Grid read_gipl_grid(const std::filesystem::path& path, const ReadImageOptions& options = {});

}  // namespace kontur
