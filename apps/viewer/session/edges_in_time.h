// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "viewer/edits/slice_edges.h"
#include "viewer/images/time_axis.h"

namespace kontur::viewer {

/// Edges of an image's volumes in time; those used last are kept. Safe for concurrent use.
class EdgesInTime {
public:
    explicit EdgesInTime(TimeAxis& times) : times_(times) {}

    /// As SliceEdges::set_further, at all times.
    void set_further(int image, const std::shared_ptr<const Image>& further);
    /// Throws as TimeAxis::image.
    std::shared_ptr<SliceEdges> at(int time);

private:
    TimeAxis& times_;
    std::mutex mutex_;
    std::map<int, std::shared_ptr<const Image>> further_;
    std::list<std::pair<int, std::shared_ptr<SliceEdges>>> kept_;  ///< the last used first
};

}  // namespace kontur::viewer
