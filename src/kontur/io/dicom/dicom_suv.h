// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace kontur {

/// The unit of such values, as `DicomIdentity::unit` has it.
inline constexpr const char* kSuvUnit = "SUV (g/ml)";

/// How a PET image's activity concentration becomes the standardized uptake value by body weight (g/ml).
struct SuvScale {
    double suv_per_bqml = 0;  ///< 0 where it cannot be told
    std::string sentence;     ///< one sentence: from what it follows, or which attribute keeps it from being told
};

/// Of a DICOM file of a PET image in Bq/ml that is corrected for decay and attenuation; nullopt for any other. The dose is
/// what was given, decayed to the time that the values were corrected to: the beginning of the scan (DecayCorrection START)
/// or when it was given (ADMIN). The scan begins at the series' time, where that is not after the acquisition's, as it is in
/// series that were processed later. Formula: QIBA, "SUV vendor-neutral pseudo-code" (2012). Throws as `dicom_identity`.
std::optional<SuvScale> suv_scale(const std::filesystem::path& file);

}  // namespace kontur
