// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/geometry.h"

namespace kontur {

/// The patient frames in which files give points and directions. Inside kontur everything is LPS.
enum class PatientFrame { lps, ras };

/// A point or direction of a file in LPS; RAS differs by half a turn about the feet-to-head axis.
inline Vec3 to_lps(PatientFrame frame, const Vec3& v) { return frame == PatientFrame::lps ? v : Vec3{-v.x, -v.y, v.z}; }

}  // namespace kontur
