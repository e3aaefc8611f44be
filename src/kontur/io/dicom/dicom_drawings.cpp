// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_drawings.h"

#include <algorithm>
#include <unordered_set>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dcmtk.h"
#include "kontur/io/dicom/dicom_start.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 4000;
constexpr std::size_t kMostFolders = 200;

/// Modality, and what follows it in files of all kinds (Manufacturer), tell what a file is.
std::string modality_of(const fs::path& file) {
    if (!has_dicom_prefix(file)) return {};
    DcmFileFormat dicom;
    dcmtk::load(dicom, file, DCM_Manufacturer);
    return dcmtk::text(*dicom.getDataset(), DCM_Modality);
}

DicomDrawing structure_set(DcmItem& dataset) {
    DicomDrawing drawing;
    drawing.label = dcmtk::text(dataset, DCM_StructureSetLabel);
    for (DcmItem* frame : dcmtk::items(dataset, DCM_ReferencedFrameOfReferenceSequence))
        for (DcmItem* study : dcmtk::items(*frame, DCM_RTReferencedStudySequence))
            for (DcmItem* series : dcmtk::items(*study, DCM_RTReferencedSeriesSequence))
                drawing.series_uids.insert(dcmtk::text(*series, DCM_SeriesInstanceUID));
    for (DcmItem* roi : dcmtk::items(dataset, DCM_StructureSetROISequence)) {
        drawing.structures.push_back(dcmtk::text(*roi, DCM_ROIName));
        if (drawing.frame_of_reference_uid.empty())
            drawing.frame_of_reference_uid = dcmtk::text(*roi, DCM_ReferencedFrameOfReferenceUID);
    }
    return drawing;
}

DicomDrawing segmentation(DcmItem& dataset) {
    DicomDrawing drawing;
    drawing.label = dcmtk::text(dataset, DCM_SeriesDescription);
    drawing.frame_of_reference_uid = dcmtk::text(dataset, DCM_FrameOfReferenceUID);
    for (DcmItem* series : dcmtk::items(dataset, DCM_ReferencedSeriesSequence))
        drawing.series_uids.insert(dcmtk::text(*series, DCM_SeriesInstanceUID));
    for (DcmItem* segment : dcmtk::items(dataset, DCM_SegmentSequence))
        drawing.structures.push_back(dcmtk::text(*segment, DCM_SegmentLabel));
    return drawing;
}

DicomDrawing read(const fs::path& file, const std::string& modality) {
    const bool is_set = modality == "RTSTRUCT";
    DcmFileFormat dicom;
    // Contours and pixels, nearly all of such a file, stand behind its lists of names.
    dcmtk::load(dicom, file, is_set ? DCM_ROIContourSequence : DCM_PixelData);
    DicomDrawing drawing = is_set ? structure_set(*dicom.getDataset()) : segmentation(*dicom.getDataset());
    drawing.file = file;
    drawing.modality = modality;
    drawing.series_uids.erase("");
    return drawing;
}

/// Regular files and folders that are neither hidden nor links, in the order of their names; none where it cannot be read.
struct Entries {
    std::vector<fs::path> files, folders;
};

Entries entries_of(const fs::path& folder) {
    Entries found;
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure)) {
        std::error_code ignored;
        if (entry->path().filename().string().starts_with('.') || entry->is_symlink(ignored)) continue;
        if (entry->is_regular_file(ignored)) found.files.push_back(entry->path());
        else if (entry->is_directory(ignored)) found.folders.push_back(entry->path());
    }
    std::ranges::sort(found.files);
    std::ranges::sort(found.folders);
    return found;
}

/// The folder's files, then those above, then those beside, each once.
std::vector<fs::path> files_near(const fs::path& folder) {
    std::vector<fs::path> files = entries_of(folder).files;
    const fs::path parent = folder.parent_path();
    if (parent == folder || parent == parent.root_path()) return files;
    const auto add = [&](const std::vector<fs::path>& more) { files.insert(files.end(), more.begin(), more.end()); };
    Entries above = entries_of(parent);
    add(above.files);
    if (above.folders.size() > kMostFolders) return files;
    for (const fs::path& beside : above.folders)
        if (beside != folder) add(entries_of(beside).files);
    return files;
}

}  // namespace

std::optional<DicomDrawing> dicom_drawing(const fs::path& file) {
    dcmtk::set_up();
    try {
        const std::string modality = modality_of(file);
        if (modality == "RTSTRUCT" || modality == "SEG") return read(file, modality);
    } catch (const Error&) {
        return std::nullopt;
    }
    return std::nullopt;
}

std::vector<DicomDrawing> dicom_drawings_near(const fs::path& folder, const std::vector<fs::path>& images,
                                              const Work& work) {
    std::unordered_set<std::string> known;
    for (const fs::path& image : images) known.insert(image.string());
    std::vector<DicomDrawing> found;
    std::size_t opened = 0;
    for (const fs::path& file : files_near(folder)) {
        if (known.contains(file.string())) continue;
        if (++opened > kMostFiles) break;
        work.check();
        if (auto drawing = dicom_drawing(file)) found.push_back(std::move(*drawing));
    }
    std::ranges::sort(found, {}, &DicomDrawing::file);
    return found;
}

}  // namespace kontur
