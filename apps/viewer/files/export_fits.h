// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "kontur/shape/volume.h"
#include "viewer/files/fitted_motion.h"
#include "viewer/files/structure_exports.h"

namespace kontur::viewer {

/// Structures as files, tables and comparisons need them, with surfaces. What was fitted last is kept, so that a drawing
/// that goes out as label map, SEG, RTSTRUCT and surfaces is fitted once; what has been drawn since is fitted anew. Safe for
/// concurrent use: two that ask at the same moment both fit.
class ExportFits {
public:
    using Fits = std::shared_ptr<const std::vector<FittedStructure>>;

    /// The image's volume at a time, from 0.
    using ImageAt = std::function<std::shared_ptr<const Image>(int time)>;

    explicit ExportFits(std::shared_ptr<const Image> image, ImageAt image_at = {}, int times = 1)
        : image_(std::move(image)), image_at_(std::move(image_at)), times_(times) {}

    /// As `fit_structures`; those that move at this time, and those drawn at another one on the image of that. They share no
    /// borders.
    Fits all(const State& state, const Work& work, std::optional<int> time = {});
    /// As `fit_structure`, likewise.
    std::shared_ptr<const FittedStructure> one(const State& state, Id structure, const Work& work,
                                               std::optional<int> time = {});
    /// Of a structure that moves.
    std::shared_ptr<const FittedMotion> motion(const State& state, Id structure, const Work& work);

private:
    struct FitsOfState {
        State state;
        Fits fits;
    };
    Fits at_opened_time(const State& state, const Work& work);
    Fits drawn_at_opened_time(const State& state, const Work& work);
    std::shared_ptr<const FittedStructure> derived(const State& state, Id structure, const Work& work);
    FittedStructure in_time(const State& state, Id structure, int time, const Work& work);
    Fits kept(const State& state, const std::function<std::vector<FittedStructure>()>& fit);

    const std::shared_ptr<const Image> image_;
    const ImageAt image_at_;
    const int times_;
    std::mutex mutex_;
    std::list<FitsOfState> kept_;  ///< the last used first
    State motion_of_;              ///< what this was fitted to:
    std::shared_ptr<const FittedMotion> motion_;
};

}  // namespace kontur::viewer
