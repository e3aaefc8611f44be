// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "kontur/derive/derive.h"
#include "kontur/shape/volume.h"
#include "viewer/files/fitted_motion.h"
#include "viewer/files/structure_exports.h"
#include "viewer/surfaces/body_outlines.h"

namespace kontur::viewer {

/// What is wanted of fitted structures.
struct FitWish {
    std::optional<int> time{};  ///< of what moves; unset: the one that was opened
    bool mesh = true;           ///< surfaces, too
};

/// Structures as files, tables and comparisons need them. What was fitted last is kept, so that a drawing
/// that goes out as label map, SEG, RTSTRUCT and surfaces is fitted once; what has been drawn since is fitted anew. Safe for
/// concurrent use: two that ask at the same moment both fit.
class ExportFits {
public:
    using Fits = std::shared_ptr<const std::vector<FittedStructure>>;

    /// The image's volume at a time, from 0.
    using ImageAt = std::function<std::shared_ptr<const Image>(int time)>;

    explicit ExportFits(std::shared_ptr<const Image> image, ImageAt image_at = {}, int times = 1,
                        std::shared_ptr<BodyOutlines> bodies = std::make_shared<BodyOutlines>())
        : image_(std::move(image)), image_at_(std::move(image_at)), times_(times), bodies_(std::move(bodies)) {}

    /// As `fit_structures`; those that move at this time, and those drawn at another one on the image of that. They share no
    /// borders.
    Fits all(const State& state, const Work& work, const FitWish& wish = {});
    /// As `fit_structure`, likewise.
    std::shared_ptr<const FittedStructure> one(const State& state, Id structure, const Work& work, const FitWish& wish = {});
    /// Of a structure that moves.
    std::shared_ptr<const FittedMotion> motion(const State& state, Id structure, const Work& work);

private:
    struct FitsOfState {
        State state;
        bool mesh;
        Fits fits;
    };
    struct MotionOfState {
        State state;
        std::shared_ptr<const FittedMotion> motion;
    };
    Fits at_opened_time(const State& state, bool mesh, const Work& work);
    Fits drawn_at_opened_time(const State& state, bool mesh, const Work& work);
    std::shared_ptr<const FittedStructure> derived(const State& state, Id structure, bool mesh, const Work& work);
    FittedStructure in_time(const State& state, Id structure, const FitWish& wish, const Work& work);
    FindBody find_body(const Work& work) const;
    Fits kept(const State& state, bool mesh, const std::function<std::vector<FittedStructure>()>& fit);

    const std::shared_ptr<const Image> image_;
    const ImageAt image_at_;
    const int times_;
    const std::shared_ptr<BodyOutlines> bodies_;
    std::mutex mutex_;
    std::list<FitsOfState> kept_;       ///< the last used first
    std::list<MotionOfState> motions_;  ///< likewise
};

}  // namespace kontur::viewer
