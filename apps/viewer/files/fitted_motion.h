// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kontur/moving/mesh_course.h"
#include "kontur/segment_moving.h"
#include "viewer/files/structure_exports.h"

// Files of a structure that moves.

namespace kontur::viewer {

/// A structure at all times of the image, as `kontur segment` makes it of its contours.
class FittedMotion {
public:
    /// Throws what `segment_moving` throws, with the structure's name.
    FittedMotion(const State& state, Id structure, const FramesToSegment& frames, int times, const Work& work);

    /// At one time, from 0, with its surface; it shares no border.
    FittedStructure at(int time) const;
    std::vector<Mask> masks() const;
    /// As `kontur segment --volumes` writes it.
    std::string volumes_csv(const std::optional<double>& step_s) const;
    Provenance provenance() const;
    std::size_t bytes() const;  ///< about as many as it takes
    const Structure& structure() const { return structure_; }
    const ContourSet& set() const { return set_; }

private:
    Structure structure_;
    ContourSet set_;
    std::vector<double> frames_;
    std::vector<DrawnMoment> moments_;
    std::optional<MaskCourse> masks_;
    std::optional<MeshCourse> meshes_;
};

}  // namespace kontur::viewer
