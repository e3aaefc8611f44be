// SPDX-License-Identifier: Apache-2.0
// What stands for the room where DCMTK or OpenJPEG is missing: it knows DICOM files, and refuses them.
#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_folder.h"
#include "kontur/io/dicom/dicom_object.h"
#include "kontur/io/dicom/dicom_phases.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/dicom_start.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/dicom/rtstruct_in_time.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse() {
    throw Error(
        ErrorKind::unsupported,
        "this kontur reads and writes no DICOM, because it was built without DCMTK and OpenJPEG; take NIfTI, NRRD or "
        "MetaImage");
}

}  // namespace

bool looks_like_dicom(const fs::path& path) { return has_dicom_prefix(path); }
bool is_dicom_seg(const fs::path&) { return false; }
bool is_rtstruct(const fs::path&) { return false; }

DicomFolder dicom_folder(const fs::path&) { refuse(); }
DicomObject dicom_object(const fs::path&) { refuse(); }
std::vector<std::string> kontur_contributions(const fs::path&) { refuse(); }

std::shared_ptr<const DicomContent> read_dicom_headers_of(const fs::path&, const Work&) { refuse(); }
std::vector<DicomSeries> list_dicom_series(const fs::path&, const Work&) { refuse(); }
std::vector<DicomSeries> list_dicom_volumes(const fs::path&, const DicomSeriesOptions&, const Work&) { refuse(); }
std::vector<DicomSeries> list_dicom_frames(const fs::path&, const DicomSeriesOptions&, const Work&) { refuse(); }
std::vector<DicomSeries> list_dicom_frames_with(const fs::path&, const std::string&, const Work&) { refuse(); }
DicomPhases list_dicom_phases(const fs::path&, const DicomSeriesOptions&, const Work&) { refuse(); }
Image read_dicom_slice(const fs::path&, std::int64_t) { refuse(); }
DicomVolume read_dicom_series(const fs::path&, const DicomSeriesOptions&, const Work&) { refuse(); }
DicomGrid read_dicom_grid(const fs::path&, const DicomSeriesOptions&, const Work&) { refuse(); }

DicomSegment fitted_segment(const StructureAttributes&) { refuse(); }
StructureAttributes attributes_of(const DicomSegment&) { refuse(); }
DicomSegmentation read_dicom_segmentation(const fs::path&, std::int64_t) { refuse(); }
DicomSeg read_dicom_seg(const fs::path&, std::optional<std::int64_t>, std::int64_t, const Work&) { refuse(); }
std::vector<Mask> read_dicom_seg_masks(const fs::path&, std::int64_t, const Work&) { refuse(); }
DicomSegments read_dicom_segments(const fs::path&, std::int64_t, const Work&) { refuse(); }
std::vector<std::string> write_dicom_seg(const fs::path&, const LabelledSegments&, const DicomSeries&,
                                         const WriteDicomSegOptions&, const Work&) {
    refuse();
}
std::vector<std::string> write_dicom_seg_masks(const fs::path&, const MaskedSegments&, const DicomSeries&,
                                               const WriteDicomSegOptions&, const Work&) {
    refuse();
}
std::vector<std::string> write_dicom_seg_over_time(const fs::path&, const MovingSegments&, const WriteDicomSegOptions&,
                                                   const Work&) {
    refuse();
}

StructureSet read_rtstruct(const fs::path&) { refuse(); }
StructureSet read_rtstruct_in_time(const fs::path&, const std::vector<DicomSeries>&) { refuse(); }
Roi select_roi(const StructureSet&, const std::optional<std::string>&) { refuse(); }
std::vector<std::string> write_rtstruct(const fs::path&, const StructureSet&, const DicomSeries&,
                                        const WriteRtstructOptions&) {
    refuse();
}

}  // namespace kontur
