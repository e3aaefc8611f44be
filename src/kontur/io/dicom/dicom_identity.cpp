// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_identity.h"

#include <array>
#include <utility>

#include "kontur/io/dicom/dcmtk.h"
#include "kontur/io/dicom/dicom_date.h"
#include "kontur/io/dicom/dicom_suv.h"

namespace kontur {
namespace {

/// The alphabetic form, family name first: "Doe^Jane^^Dr" is "Doe, Jane".
std::string readable_name(const std::string& stored) {
    const std::string alphabetic = stored.substr(0, stored.find('='));
    const std::size_t family = alphabetic.find('^');
    if (family == std::string::npos) return alphabetic;
    const std::size_t given = alphabetic.find('^', family + 1);
    const std::string second = alphabetic.substr(family + 1, given == std::string::npos ? given : given - family - 1);
    return second.empty() ? alphabetic.substr(0, family) : alphabetic.substr(0, family) + ", " + second;
}

/// PS3.3 C.8.9.1 (Units of PET), C.8.8.3 (DoseUnits), C.11.1 (RescaleType).
std::string unit_of(DcmItem& item, const std::string& modality) {
    static constexpr std::array<std::pair<const char*, const char*>, 8> kUnits{{{"BQML", "Bq/ml"},
                                                                                {"GML", kSuvUnit},
                                                                                {"CM2ML", "SUV (cm2/ml)"},
                                                                                {"CNTS", "counts"},
                                                                                {"PROPCNTS", "counts"},
                                                                                {"GY", "Gy"},
                                                                                {"RELATIVE", "relative dose"},
                                                                                {"US", ""}}};
    std::string stored = dcmtk::text(item, modality == "PT"       ? DCM_Units
                                           : modality == "RTDOSE" ? DCM_DoseUnits
                                                                  : DCM_RescaleType);
    if (stored.empty() && modality == "CT") return "HU";
    for (const auto& [name, unit] : kUnits)
        if (stored == name) return unit;
    return stored;
}

}  // namespace

DicomIdentity dicom_identity(const std::filesystem::path& file) {
    dcmtk::set_up();
    DcmFileFormat dicom;
    dcmtk::load(dicom, file, DCM_PixelData);
    DcmItem& item = *dicom.getDataset();
    DicomIdentity identity;
    identity.patient_name = readable_name(dcmtk::text(item, DCM_PatientName));
    identity.patient_id = dcmtk::text(item, DCM_PatientID);
    identity.birth_date = readable_date(dcmtk::text(item, DCM_PatientBirthDate));
    identity.study_date = readable_date(dcmtk::text(item, DCM_StudyDate));
    identity.study_description = dcmtk::text(item, DCM_StudyDescription);
    identity.series_number = dcmtk::text(item, DCM_SeriesNumber);
    identity.series_description = dcmtk::text(item, DCM_SeriesDescription);
    identity.modality = dcmtk::text(item, DCM_Modality);
    identity.unit = unit_of(item, identity.modality);
    return identity;
}

}  // namespace kontur
