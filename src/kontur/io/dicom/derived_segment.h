// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/io/dicom/dicom_seg.h"

namespace kontur {

/// A segment of a structure that a rule made: what is said of it, without name and number.
DicomSegment derived_segment(const StructureAttributes& attributes);

}  // namespace kontur
