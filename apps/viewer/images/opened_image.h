// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kontur/io/dicom/dicom_identity.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/shape/volume.h"
#include "viewer/images/image_reference.h"
#include "viewer/images/time_axis.h"

namespace kontur::viewer {

/// An image ready to work on.
struct OpenedImage {
    std::shared_ptr<const Image> image;
    std::string title;
    ImageReference reference;
    std::vector<std::string> notes;        ///< what had to be decided on reading
    std::string frame_of_reference_uid{};  ///< of DICOM images; "" when none is named
    std::optional<DicomSeries> series{};   ///< what DICOM files that are made of the project refer to
    DicomIdentity identity{};              ///< whose image it is; of other files all is empty
    Times times{};                         ///< the others in time, where there are any
};

}  // namespace kontur::viewer
