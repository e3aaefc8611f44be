// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.h"
#include "kontur/base/work.h"
#include "roi_drawings.h"
#include "roi_outputs.h"

namespace kontur::app {

/// Throws, before anything is fitted, what the rules of `segment --rules` are refused for.
void check_roi_derivation(const SegmentCommand& command, const RoiDrawings& drawings);

/// Puts what the rules make of the ROIs behind these.
void add_derived_rois(const SegmentCommand& command, const RoiDrawings& drawings, RoiResults& results, const Work& work);

}  // namespace kontur::app
