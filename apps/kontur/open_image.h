// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "files.h"
#include "kontur/base/work.h"
#include "viewer/images/opened_image.h"

namespace kontur::app {

/// What the user of a command should know.
struct Messages {
    std::vector<std::string> notes, warnings;
};

/// An image for the viewer, PET in Bq/ml as SUV; `viewer::kExample` is the phantom where there is no such file. Throws what
/// the readers throw.
viewer::OpenedImage open_image(const ImageInput& input, const Work& work, Messages& messages);

}  // namespace kontur::app
