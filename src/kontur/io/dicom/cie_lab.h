// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: DICOM's way to store a colour.

#include <array>
#include <cstdint>

namespace kontur {

using Rgb8 = std::array<std::uint8_t, 3>;  ///< sRGB
using DicomLab =
    std::array<std::uint16_t, 3>;  ///< CIELab of illuminant D50: L* 0 to 100, a* and b* -128 to 127, as 0 to 65535

/// Source: IEC 61966-2-1 (sRGB), ICC.1 (D50), DICOM PS3.3 C.10.7.1.1.
DicomLab to_dicom_lab(const Rgb8& rgb);
Rgb8 to_rgb(const DicomLab& lab);

}  // namespace kontur
