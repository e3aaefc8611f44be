// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "viewer/session/session_state.h"

namespace kontur::viewer {

/// Of a task with contours of several times: a motion, and for the hand the contours of the time that is looked at, or of
/// the nearest one at which something was drawn. Where little was drawn at it, sections stand for contours in planes that
/// were drawn at other times. `times` are those of the contours, in order, not all the same.
void turn_into_motion(SurfaceTask& task, const std::vector<int>& times, SessionState& s);

}  // namespace kontur::viewer
