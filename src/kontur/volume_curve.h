// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kontur/moving/mask_course.h"
#include "kontur/segment.h"

namespace kontur {

/// A moment at which something was drawn.
struct DrawnMoment {
    double time = 0;           ///< frame, from 1, or seconds
    std::size_t contours = 0;  ///< drawn at it
    std::size_t carried = 0;   ///< sections in planes that were drawn at other moments alone
    ContourSet set{};          ///< what it was fitted to: what was drawn, and then these sections
    Segmentation segmentation;
};

/// The true volume lies within in 90 %.
struct VolumeInterval {
    double low_ml = 0, high_ml = 0;
};

/// Likewise an ejection fraction, from 0 to 1.
struct FractionInterval {
    double low = 0, high = 0;
};

/// A volume over time.
struct VolumeCurve {
    std::vector<double> volumes_ml;         ///< of the masks
    std::vector<VolumeInterval> intervals;  ///< of each; none where a moment has too few planes to tell
    std::size_t largest = 0, smallest = 0;  ///< the first ones of a tie
    double stroke_ml() const { return volumes_ml[largest] - volumes_ml[smallest]; }
    /// Of the largest volume, from 0 to 1; of a heart's ventricle. 0 where all masks are empty.
    double ejection_fraction() const { return volumes_ml[largest] > 0 ? stroke_ml() / volumes_ml[largest] : 0; }
    /// Of all frames' extremes, as if their errors were independent; unset without intervals or a volume.
    std::optional<FractionInterval> ejection_interval() const;
};

/// The volumes, and which of them are the extremes.
VolumeCurve volume_curve(std::vector<double> volumes_ml, std::vector<VolumeInterval> intervals = {});

/// A sentence where several frames (from 1) are the largest, or the smallest; else "".
std::string note_of_ties(const VolumeCurve& curve);

/// How sure the volume of a moment is.
struct MomentSureness {
    double low = 0, high = 0;  ///< the true volume over the fitted one lies within these, in 90 %
    double carried = 0;        ///< share of its contours that stand for ones that were not drawn
};

/// Of each moment; none where one of them has too few planes to tell.
std::vector<MomentSureness> sureness_of(const std::vector<DrawnMoment>& moments);

/// Intervals of volumes at times. At a moment it is that of its surface (surface_uncertainty.h), wider where contours were
/// carried there; between two moments what differs between them adds to it, and how long it takes. None where `moments` has
/// none.
std::vector<VolumeInterval> volume_intervals(const MaskCourse& course, const std::vector<MomentSureness>& moments,
                                             std::span<const double> times, const std::vector<double>& volumes_ml);

/// A table of the volumes as CSV: frame (from 1), time_s, volume_ml, contours drawn there, phase, low_ml, high_ml. `step_s`
/// is from one time to the next.
std::string volumes_csv(const std::vector<double>& times, const VolumeCurve& curve, const std::vector<DrawnMoment>& moments,
                        const std::optional<double>& step_s);

}  // namespace kontur
