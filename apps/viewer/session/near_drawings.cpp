// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_drawings.h"
#include "viewer/model/model_json.h"
#include "viewer/model/temporary_files.h"
#include "viewer/session/replies.h"

// What others have drawn on a DICOM image, in files near it.

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

bool is_of(const DicomDrawing& drawing, const DicomSeries& series) {
    return drawing.series_uids.contains(series.series_uid);
}

/// Those of the very series first: another one in the same frame of reference may be the planning CT of this PET.
std::vector<DicomDrawing> drawings_of(const DicomSeries& series, const std::string& frame, const Work& work) {
    std::vector<DicomDrawing> near = dicom_drawings_near(series.files.front().parent_path(), series.files, work);
    std::erase_if(near, [&](const DicomDrawing& one) {
        const bool shares_frame = !frame.empty() && one.frame_of_reference_uid == frame;
        return one.structures.empty() || !(is_of(one, series) || shares_frame);
    });
    std::stable_partition(near.begin(), near.end(), [&](const DicomDrawing& one) { return is_of(one, series); });
    return near;
}

}  // namespace

std::string drawings_reply(const SessionState& s, const StopToken& stop) {
    json list = json::array();
    if (s.image.series)
        for (const DicomDrawing& one : drawings_of(*s.image.series, s.image.frame_of_reference_uid, {.stop = stop}))
            list.push_back({{"file", one.file.string()},
                            {"name", one.file.filename().string()},
                            {"modality", one.modality},
                            {"label", one.label},
                            {"structures", one.structures},
                            {"own_series", is_of(one, *s.image.series)}});
    return to_text({{"drawings", std::move(list)}});
}

ImportReply import_near(SessionState& s, const fs::path& file, const Upload& upload, const StopToken& stop) {
    std::vector<DicomDrawing> near;
    if (s.image.series) near = drawings_of(*s.image.series, s.image.frame_of_reference_uid, {.stop = stop});
    if (std::ranges::find(near, file, &DicomDrawing::file) == near.end())
        throw Error(ErrorKind::invalid_input, "no such structure set or segmentation lies near the image");
    Upload found = upload;
    found.extension = ".dcm";
    found.file = file.filename().string();
    return import(s, read_bytes(file), found, stop);
}

}  // namespace kontur::viewer
