// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: whether a structure set was approved (DICOM PS3.3 C.8.8.16). It counts for all of its ROIs. Uses DCMTK's
// types.

#include <string>
#include <vector>

#include "kontur/io/dicom/dcmtk.h"
#include "kontur/io/dicom/rtstruct.h"

namespace kontur {

/// Of an approved set each ROI is approved. `set.notes` has who rejected it, if somebody did.
void read_approval(DcmItem& dataset, StructureSet& set);

/// Approved if all ROIs are, by who did so last; the notes say what DICOM has no room for.
void put_approval(DcmItem& document, const std::vector<Roi>& rois, std::vector<std::string>& notes);

}  // namespace kontur
