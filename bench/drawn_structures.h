// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/volume.h"

namespace kontur {

inline const Work kAlone{.threads = 1};

/// What bench/image_sources.py lists: an image and the mask of what it shows.
struct Structure {
    std::string name;
    Image image;
    Mask truth;
};

/// From the words of bench/image_sources.py: NAME IMAGE LABELS LABEL [FRAME] or NAME phantom ORGAN SPACING_MM.
Structure read_structure(const std::vector<std::string>& words);

/// Planes of a kind, and how contours are to be drawn in them.
struct WantedDrawing {
    std::string kind;
    int count;
    bool by_hand;

    std::string name() const { return kind + "," + std::to_string(count) + (by_hand ? ",hand" : ",exact"); }
};

/// All of them, or those that the environment's KONTUR_IMAGES names, as axial,3,exact;...
std::vector<WantedDrawing> wanted_drawings();

/// The mask's sections in those planes.
ContourSet drawn(const Structure& structure, const WantedDrawing& wanted);

}  // namespace kontur
