// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "kontur/base/work.h"
#include "kontur/shape/provenance.h"

namespace kontur::app {

/// Digests of the files that went in. An image of a DICOM series stands for all files of its folder.
Provenance input_digests(const SegmentCommand& command, const Work& work);

/// How a file was made by another command than `segment`: its name, digests of what went in (name and path; empty paths are
/// left out), the version, the options as used and, with that name in front, what the inputs say about how they were made.
Provenance made_by(const std::string& command, const std::vector<std::pair<std::string, std::filesystem::path>>& inputs,
                   const std::string& options, const Work& work);

/// Such as "2026-11-21T09:30:00Z": SOURCE_DATE_EPOCH where it is set (reproducible-builds.org), else now. Throws
/// Error(invalid_input) when that is no number of seconds in the years 1970 to 9999.
std::string utc_date();

}  // namespace kontur::app
