// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "define.h"
#include "kontur/segment_options.h"

namespace kontur::python {

/// The options of `segment` as keywords.
Keywords<SegmentOptions> segment_keywords();

}  // namespace kontur::python
