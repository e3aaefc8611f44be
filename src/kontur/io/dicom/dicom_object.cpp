// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_object.h"

#include "kontur/base/error.h"
#include "kontur/io/dicom/dcmtk.h"
#include "kontur/io/dicom/dicom_start.h"

namespace kontur {

DicomObject dicom_object(const std::filesystem::path& file) {
    dcmtk::set_up();
    if (!has_dicom_prefix(file)) throw Error(ErrorKind::corrupt_file, file.string() + " is no DICOM file");
    DcmFileFormat dicom;
    dcmtk::load(dicom, file, DCM_PixelData);
    DcmItem& item = *dicom.getDataset();
    DicomObject object{dcmtk::text(item, DCM_StudyInstanceUID), dcmtk::text(item, DCM_SeriesInstanceUID),
                       dcmtk::text(item, DCM_SOPInstanceUID), dcmtk::text(item, DCM_Modality)};
    if (object.study_uid.empty() || object.series_uid.empty() || object.instance_uid.empty())
        throw Error(ErrorKind::corrupt_file, file.string() + " does not name its study, series and instance");
    return object;
}

std::vector<std::string> kontur_contributions(const std::filesystem::path& file) {
    dcmtk::set_up();
    DcmFileFormat dicom;
    dcmtk::load(dicom, file, DCM_PixelData);
    std::vector<std::string> descriptions;
    for (DcmItem* equipment : dcmtk::items(*dicom.getDataset(), DCM_ContributingEquipmentSequence))
        if (dcmtk::text(*equipment, DCM_Manufacturer) == "kontur")
            descriptions.push_back(dcmtk::text(*equipment, DCM_ContributionDescription));
    return descriptions;
}

}  // namespace kontur
