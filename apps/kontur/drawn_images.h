// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "files.h"
#include "kontur/base/work.h"
#include "kontur/io/dicom/dicom_drawings.h"

namespace kontur::app {

/// The images that a structure set or segmentation was drawn on, where they lie in its folder, below it or in a folder
/// beside it; nullopt where they do not.
std::optional<ImageInput> images_of(const DicomDrawing& drawing, const Work& work);

}  // namespace kontur::app
