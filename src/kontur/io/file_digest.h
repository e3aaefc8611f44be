// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kontur/base/work.h"

namespace kontur {

/// SHA-256 of a file's bytes, as 64 hexadecimal digits, as sha256sum prints it. Of a folder: the SHA-256 of the sorted
/// digests of its files, one per line, which does not depend on their names: those directly in it, or, where it holds no
/// DICOM image itself, all below it (`dicom_folder`). Throws Error(io).
std::string file_sha256(const std::filesystem::path& path, const Work& work = {});

/// Of one file its digest; of several the SHA-256 of their digests in this order, one per line.
std::string files_sha256(const std::vector<std::filesystem::path>& paths, const Work& work = {});

}  // namespace kontur
