// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: what the items of a structure set say about a ROI beside its contours (DICOM PS3.3 C.8.8.5, C.8.8.6 and
// C.8.8.8). Uses DCMTK's types.

#include <cstdint>
#include <string>
#include <vector>

#include "kontur/io/dicom/dcmtk.h"
#include "kontur/shape/structure_attributes.h"

namespace kontur {

/// From an item of each of the three lists that a structure set consists of. What cannot be carried is told in `notes`.
void read_entry(DcmItem& entry, StructureAttributes& attributes);
void read_roi_contour(DcmItem& roi_contour, StructureAttributes& attributes);
void read_observation(DcmItem& observation, StructureAttributes& attributes, std::vector<std::string>& notes);

/// What DICOM has room for; notes say what is left out or written otherwise. Throws Error(invalid_input) for a text that is
/// no UTF-8 and a property that is no number.
StructureAttributes storable(StructureAttributes attributes, const std::string& roi, std::vector<std::string>& notes);

/// Storable attributes into the same items.
void put_entry(DcmItem& entry, const StructureAttributes& attributes);
void put_roi_contour(DcmItem& roi_contour, const StructureAttributes& attributes);
void put_observation(DcmItem& observation, const StructureAttributes& attributes);

}  // namespace kontur
