// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kontur/segment_report.h"

namespace kontur {

/// The report as JSON of several lines with a line break at its end: what `kontur segment --report` writes and Python's
/// `SegmentReport.to_json` gives. Keys and order are stable, further keys may follow; docs/command-line.md describes them.
/// Unlike in C++ contours are counted from 1; `seconds` has a `total`; `peak_memory_mb` is that of the calling process now.
/// NaN and infinity become null, and what is no UTF-8 gets replacement characters.
std::string to_json(const SegmentReport& report, const Provenance& provenance = {});

/// Over all stages in the report.
double total_seconds(const SegmentReport& report);

}  // namespace kontur
