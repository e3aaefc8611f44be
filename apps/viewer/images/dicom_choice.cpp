// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/dicom_choice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_identity.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/image.h"
#include "kontur/view/reslice.h"
#include "kontur/view/window.h"
#include "viewer/model/binary_reply.h"

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

/// All of a slice, its longer side in as many pixels as a thumbnail has.
Reslice small_raster(const Grid& grid) {
    const Vec3 row = grid.index_to_mm.column(0), column = grid.index_to_mm.column(1);
    const double width_mm = norm(row) * static_cast<double>(grid.size.i);
    const double height_mm = norm(column) * static_cast<double>(grid.size.j);
    const double pixel_mm = std::max(width_mm, height_mm) / kThumbnailPixels;
    const auto pixels = [&](double mm) { return std::max(1, static_cast<int>(mm / pixel_mm)); };
    const Plane plane{grid.bounds_mm().center(), normalized(cross(row, column)), normalized(row), normalized(column)};
    return centered_reslice(plane, pixels(width_mm), pixels(height_mm), pixel_mm);
}

/// The slice in the middle, in shades of the image's own window.
std::string picture_of(const Image& image) {
    const Reslice raster = small_raster(image.grid);
    const Window window = suggest_window(image);
    const std::vector<float> values = reslice(image, raster, static_cast<float>(window.center - window.width));
    std::vector<std::uint8_t> pixels(values.size());
    std::ranges::transform(values, pixels.begin(), [&](float value) {
        return static_cast<std::uint8_t>(std::lround(255 * brightness(value, window)));
    });
    BinaryReply reply(json{{"width", raster.width}, {"height", raster.height}});
    reply.add<std::uint8_t>("pixels", pixels);
    return reply.bytes();
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
    return picture_of(read_dicom_slice(file, frame));
}

std::string frame_thumbnail(const std::filesystem::path& file, std::int64_t frame) {
    ReadImageOptions options;
    options.frame = frame;
    return picture_of(read_image(file, options));
}

}  // namespace kontur::viewer
