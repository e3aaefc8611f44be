// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "facts.h"
#include "kontur/segment.h"

namespace kontur::app {

/// The report file of `kontur segment`: keys and order are stable, further keys may follow. `seconds` holds the wall time of
/// each stage, reading and writing included, and their `total`.
Facts report_json(const SegmentReport& report, const Provenance& made);

/// Over all stages in the report.
double total_seconds(const SegmentReport& report);

/// The largest resident memory of this process so far, in MB (10^6 bytes).
double peak_memory_mb();

}  // namespace kontur::app
