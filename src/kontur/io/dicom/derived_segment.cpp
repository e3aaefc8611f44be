// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/derived_segment.h"

namespace kontur {

DicomSegment derived_segment(const StructureAttributes& attributes) {
    DicomSegment segment = fitted_segment(attributes);
    segment.algorithm_type = "AUTOMATIC";
    segment.algorithm_name = "kontur derive";
    return segment;
}

}  // namespace kontur
