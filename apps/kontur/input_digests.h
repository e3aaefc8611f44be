// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "commands.h"
#include "kontur/base/progress.h"
#include "kontur/shape/provenance.h"

namespace kontur::app {

/// Digests of the files that went in. An image of a DICOM series stands for all files of its folder.
Provenance input_digests(const SegmentCommand& command, const Progress& progress);

/// Such as "2026-11-21T09:30:00Z": SOURCE_DATE_EPOCH where it is set (reproducible-builds.org), else now.
std::string utc_date();

}  // namespace kontur::app
