// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kontur {

/// Whose image a DICOM file is, and what it shows, for people to read: all values as the file has them in UTF-8, "" what it
/// does not say.
struct DicomIdentity {
    std::string patient_name;  ///< "Doe^Jane" as "Doe, Jane"
    std::string patient_id;
    std::string birth_date;  ///< YYYY-MM-DD; this and the next as they stand where that is no date
    std::string study_date;
    std::string study_description;
    std::string series_number;
    std::string series_description;
    std::string modality;
    std::string unit;  ///< of the values: "HU", "Bq/ml", "SUV (g/ml)", "Gy", ...
};

/// Reads the elements before the pixels. Throws as `read_dicom_headers`: Error(io) and Error(corrupt_file).
DicomIdentity dicom_identity(const std::filesystem::path& file);

}  // namespace kontur
