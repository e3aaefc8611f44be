// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: the pixels of a stack of slices.

#include "kontur/base/work.h"
#include "kontur/io/dicom/dicom_stack.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Throws Error(unsupported), naming the variant and the file, when the pixels of some slice cannot be read: colour,
/// a lookup table, an unknown compression, more than 32 bits.
void check_pixel_formats(const DicomStack& stack);

/// The samples of all slices in modality units, slice after slice, in the narrowest type that holds them; float when some
/// slope or intercept is not an integer. Throws Error(corrupt_file), naming the file, when pixels are missing.
Image::Samples read_pixels(const DicomStack& stack, const Work& work);

}  // namespace kontur
