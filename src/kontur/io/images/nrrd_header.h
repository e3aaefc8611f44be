// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "kontur/io/bytes/input_file.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/images/read_image_options.h"
#include "kontur/io/images/voxel_stream.h"

namespace kontur {

/// A NRRD header as it stands in the file. Internal to io.
struct NrrdHeader {
    TextHeader fields;                        ///< by lower-case name
    std::map<std::string, std::string> keys;  ///< key:=value pairs, unescaped
};

/// Reads up to the empty line before the voxels, or to the end of a detached header.
NrrdHeader read_nrrd_header(InputFile& file);

/// What the fields mean: size, type, geometry.
struct NrrdLayout {
    Grid grid;
    VoxelEncoding encoding;
};
NrrdLayout nrrd_layout(const TextHeader& fields, const ReadImageOptions& options);

}  // namespace kontur
