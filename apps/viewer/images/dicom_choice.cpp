// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/dicom_choice.h"

#include <map>
#include <nlohmann/json.hpp>

#include "kontur/io/dicom/dicom_identity.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/image.h"
#include "viewer/images/slice_picture.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr int kThumbnailPixels = 112;

json volume_json(const DicomSeries& series, int volume) {
    const DicomIdentity identity = dicom_identity(series.files.front());
    const std::size_t middle = series.files.size() / 2;
    return {{"series", series.series_uid},
            {"volume", volume},
            {"modality", series.modality},
            {"description", series.description},
            {"distinction", series.distinction},
            {"slices", series.files.size()},
            {"columns", series.columns},
            {"rows", series.rows},
            {"patient_name", identity.patient_name},
            {"patient_id", identity.patient_id},
            {"study_date", identity.study_date},
            {"study_description", identity.study_description},
            {"series_number", identity.series_number},
            {"frame_of_reference_uid", series.frame_of_reference_uid},
            {"picture", {{"file", series.files[middle].string()}, {"frame", series.frames[middle]}}}};
}

}  // namespace

json dicom_volumes(const std::filesystem::path& folder, const Work& work) {
    json volumes = json::array();
    std::map<std::string, int> volumes_of;
    for (const DicomSeries& series : list_dicom_series(folder, work))
        volumes.push_back(volume_json(series, ++volumes_of[series.series_uid]));
    return volumes;
}

std::string thumbnail(const std::filesystem::path& file, std::int64_t frame) {
    return slice_picture(read_dicom_slice(file, frame), kThumbnailPixels);
}

std::string frame_thumbnail(const std::filesystem::path& file, std::int64_t frame) {
    ReadImageOptions options;
    options.frame = frame;
    return slice_picture(read_image(file, options), kThumbnailPixels);
}

}  // namespace kontur::viewer
