// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "kontur/shape/volume.h"
#include "viewer/files/structure_exports.h"

namespace kontur::viewer {

/// Structures as files, tables and comparisons need them, with surfaces. What was fitted last is kept, so that a drawing
/// that goes out as label map, SEG, RTSTRUCT and surfaces is fitted once; what has been drawn since is fitted anew. Safe for
/// concurrent use: two that ask at the same moment both fit.
class ExportFits {
public:
    using Fits = std::shared_ptr<const std::vector<FittedStructure>>;

    explicit ExportFits(std::shared_ptr<const Image> image) : image_(std::move(image)) {}

    /// As `fit_structures`.
    Fits all(const State& state, const Work& work);
    /// As `fit_structure`.
    std::shared_ptr<const FittedStructure> one(const State& state, Id structure, const Work& work);

private:
    struct FitsOfState {
        State state;
        Fits fits;
    };
    Fits kept(const State& state, const std::function<std::vector<FittedStructure>()>& fit);

    const std::shared_ptr<const Image> image_;
    std::mutex mutex_;
    std::list<FitsOfState> kept_;  ///< the last used first
};

}  // namespace kontur::viewer
