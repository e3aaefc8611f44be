// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "commands.h"
#include "facts.h"
#include "kontur/segment_moving.h"

namespace kontur::app {

/// Whether contours of several moments were drawn, or a curve over time is wanted.
bool is_moving(const SegmentCommand& command, const ContourSet& contours);

/// Whether its picture is to move (.apng).
bool is_animation(const SegmentCommand& command);

/// Throws Error(invalid_input) for options of `segment` that are about one moment alone.
void check_moving_words(const SegmentCommand& command);

/// Segments an object that moves: a mask in each frame of a 4D image, and its volumes. Writes and prints as `segment` does.
void segment_moving(const SegmentCommand& command, ReadContours contours, Console& console);

/// The content of --report.
Facts moving_report(const MovingSegmentation& result, const Provenance& provenance);

/// "largest in frame 1 (139.8 ml), smallest in frame 8 (60.2 ml)".
std::string extremes_of(const VolumeCurve& curve);

}  // namespace kontur::app
