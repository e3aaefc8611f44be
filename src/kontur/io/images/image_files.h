// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace kontur {

/// A header and the file with its voxels beside it, of one stem: NIfTI's .hdr and .img, either of them compressed (.gz) or
/// not. Not part of the public API, as is the rest of this file.
struct ImagePair {
    std::filesystem::path header, voxels;
};

/// The pair that one of its two names stands for; nullopt for other names. The other file is the one that is there; where
/// there is none, the one of the same spelling.
std::optional<ImagePair> image_pair(const std::filesystem::path& either);

/// All files that an image file's name stands for: itself, and the file with the voxels where its header names another one
/// or is one of a pair. Voxel files that are not there are left out. A digest of an image is one of all of them. Throws what
/// reading the header throws, for a folder Error(io).
std::vector<std::filesystem::path> image_files(const std::filesystem::path& path);

}  // namespace kontur
