// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_header.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_frames.h"
#include "kontur/io/dicom/dicom_start.h"

namespace kontur {
namespace {

Error corrupt(const std::string& message) { return Error(ErrorKind::corrupt_file, message); }

DicomRescale read_rescale(DcmItem& item) {
    DicomRescale rescale;
    rescale.slope = dcmtk::first_decimal(item, DCM_RescaleSlope).value_or(1);
    rescale.intercept = dcmtk::first_decimal(item, DCM_RescaleIntercept).value_or(0);
    if (rescale.slope == 0) throw corrupt("RescaleSlope (0028,1053) is 0");
    if (!std::isfinite(rescale.slope) || !std::isfinite(rescale.intercept))
        throw corrupt("RescaleSlope (0028,1053) or RescaleIntercept (0028,1052) is not finite");
    return rescale;
}

void read_transfer_syntax(DcmFileFormat& file, DicomHeader& header) {
    const dcmtk::Syntax syntax = dcmtk::syntax_of(file);
    const E_TransferSyntax known = file.getDataset()->getOriginalXfer();
    header.transfer_syntax = syntax.name;
    if (!syntax.known) {
        header.decodable = false;
        return;
    }
    switch (known) {
        case EXS_JPEGProcess1:
        case EXS_JPEGProcess2_4:
        case EXS_JPEGProcess14:
        case EXS_JPEGProcess14SV1:
        case EXS_JPEGLSLossless:
        case EXS_JPEGLSLossy:
        case EXS_RLELossless:
        case EXS_JPEG2000LosslessOnly:
        case EXS_JPEG2000:
            header.decodable = true;
            break;
        default:
            header.decodable = !DcmXfer(known).isEncapsulated();
    }
}

/// Only for pixels that lie in the file as they are; what a compressed slice unpacks to is checked when it is decoded.
void check_pixels_fit(const DicomHeader& header, const DcmXfer& syntax, std::int64_t bits_allocated) {
    if (syntax.isEncapsulated() || syntax.getStreamCompression() != ESC_none) return;
    const auto claimed = header.frames * header.rows * header.columns * (std::min<std::int64_t>(bits_allocated, 64) / 8);
    const auto file_bytes = static_cast<std::int64_t>(std::filesystem::file_size(header.path));
    if (claimed > file_bytes)
        throw corrupt("the header claims " + std::to_string(claimed) + " bytes of pixels, the file has " +
                      std::to_string(file_bytes) + " bytes");
}

/// The first element without which nobody knows where the image lies; "": all are there.
std::string missing_for_place(DcmDataset& dataset) {
    for (const DcmTagKey& tag : {DCM_ImagePositionPatient, DCM_ImageOrientationPatient, DCM_PixelSpacing})
        if (!dataset.tagExistsWithValue(tag)) return dcmtk::tag_name(tag) + " is missing";
    return "";
}

bool is_placed(DcmDataset& dataset) { return missing_for_place(dataset).empty(); }

/// Some scanners put a sequence of frames beside the placement of a single one, which then counts.
bool has_placed_frames(DcmDataset& dataset) {
    return dataset.tagExists(DCM_PerFrameFunctionalGroupsSequence) &&
           (!is_placed(dataset) || dcmtk::integer(dataset, DCM_NumberOfFrames).value_or(1) > 1);
}

std::optional<double> decimal_of_group(const dcmtk::Frame& frame, const DcmTagKey& group, const DcmTagKey& tag) {
    DcmItem* found = frame.group(group);
    return found ? dcmtk::first_decimal(*found, tag) : std::nullopt;
}

std::optional<std::int64_t> integer_of_group(const dcmtk::Frame& frame, const DcmTagKey& group, const DcmTagKey& tag) {
    DcmItem* found = frame.group(group);
    return found ? dcmtk::integer(*found, tag) : std::nullopt;
}

std::string frame_type(const dcmtk::Frame& frame) {
    for (const DcmTagKey& group : {DCM_MRImageFrameTypeSequence, DCM_CTImageFrameTypeSequence, DCM_PETFrameTypeSequence})
        if (DcmItem* found = frame.group(group)) return dcmtk::text(*found, DCM_FrameType);
    return {};
}

/// The file's header with what the frame says about itself.
DicomHeader read_frame_header(DicomHeader header, const dcmtk::Frame& frame, std::int64_t number) {
    header.frame = number;
    header.instance_number = number;
    header.placement = frame.placement();
    header.thickness_mm = decimal_of_group(frame, DCM_PixelMeasuresSequence, DCM_SliceThickness);
    if (DcmItem* values = frame.group(DCM_PixelValueTransformationSequence)) header.rescale = read_rescale(*values);
    header.frame_type = frame_type(frame);
    header.temporal_position = integer_of_group(frame, DCM_FrameContentSequence, DCM_TemporalPositionIndex);
    header.acquisition_number = integer_of_group(frame, DCM_FrameContentSequence, DCM_FrameAcquisitionNumber);
    header.trigger_time_ms = decimal_of_group(frame, DCM_CardiacSynchronizationSequence, DCM_NominalCardiacTriggerDelayTime);
    header.beat_ms = decimal_of_group(frame, DCM_CardiacSynchronizationSequence, DCM_RRIntervalTimeNominal);
    header.echo_time_ms = decimal_of_group(frame, DCM_MREchoSequence, DCM_EffectiveEchoTime);
    header.b_value = decimal_of_group(frame, DCM_MRDiffusionSequence, DCM_DiffusionBValue);
    return header;
}

/// Of an element that only tells slices at one place apart: what is no integer, such as "5.0", counts as not given.
std::optional<std::int64_t> integer_if_any(DcmItem& item, const DcmTagKey& tag) {
    try {
        return dcmtk::integer(item, tag);
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// All but the placement.
DicomHeader read_image_header(const std::filesystem::path& path, DcmFileFormat& file) {
    DcmDataset& dataset = *file.getDataset();
    DicomHeader header;
    header.path = path;
    header.sop_class_uid = dcmtk::text(dataset, DCM_SOPClassUID);
    header.sop_instance_uid = dcmtk::text(dataset, DCM_SOPInstanceUID);
    header.series_uid = dcmtk::text(dataset, DCM_SeriesInstanceUID);
    header.frame_of_reference_uid = dcmtk::text(dataset, DCM_FrameOfReferenceUID);
    header.patient_id = dcmtk::text(dataset, DCM_PatientID);
    header.modality = dcmtk::text(dataset, DCM_Modality);
    header.description = dcmtk::text(dataset, DCM_SeriesDescription);
    read_transfer_syntax(file, header);
    header.rows = dcmtk::integer(dataset, DCM_Rows).value_or(0);
    header.columns = dcmtk::integer(dataset, DCM_Columns).value_or(0);
    constexpr std::int64_t kMostRows = 65535;  // of their 16 bits; a file may store them as text of any length
    if (header.rows < 1 || header.columns < 1 || header.rows > kMostRows || header.columns > kMostRows)
        throw corrupt("the image has " + std::to_string(header.rows) + " rows and " + std::to_string(header.columns) +
                      " columns");
    header.frames = std::max<std::int64_t>(1, dcmtk::integer(dataset, DCM_NumberOfFrames).value_or(1));
    // Its product with 65535 rows, as many columns and 8 bytes stays below 2^63.
    constexpr std::int64_t kMostFrames = std::int64_t{1} << 27;
    if (header.frames > kMostFrames)
        throw corrupt("the image has " + std::to_string(header.frames) + " frames; at most " + std::to_string(kMostFrames) +
                      " are possible");
    header.bits_stored = dcmtk::integer(dataset, DCM_BitsStored).value_or(0);
    header.is_signed = dcmtk::integer(dataset, DCM_PixelRepresentation).value_or(0) == 1;
    header.photometric_interpretation = dcmtk::text(dataset, DCM_PhotometricInterpretation);
    header.has_lookup_table = dataset.tagExists(DCM_ModalityLUTSequence);
    header.rescale = read_rescale(dataset);
    header.thickness_mm = dcmtk::first_decimal(dataset, DCM_SliceThickness);
    header.temporal_position = integer_if_any(dataset, DCM_TemporalPositionIdentifier);
    header.acquisition_number = integer_if_any(dataset, DCM_AcquisitionNumber);
    header.echo_number = integer_if_any(dataset, DCM_EchoNumbers);
    header.trigger_time_ms = dcmtk::first_decimal(dataset, DCM_TriggerTime);
    header.beat_ms = dcmtk::first_decimal(dataset, DCM_NominalInterval);
    header.instance_number = integer_if_any(dataset, DCM_InstanceNumber);
    if (dataset.tagExists(DCM_FloatPixelData) || dataset.tagExists(DCM_DoubleFloatPixelData))
        throw Error(ErrorKind::unsupported,
                    "its pixels are floating-point numbers, as of a parametric map, which are not read; dcmqi's "
                    "paramap2itkimage converts them");
    check_pixels_fit(header, DcmXfer(dataset.getOriginalXfer()), dcmtk::integer(dataset, DCM_BitsAllocated).value_or(0));
    return header;
}

/// The heights of a dose grid's planes above the first one, along the normal, in mm (PS3.3 C.8.8.3.2): GridFrameOffsetVector
/// counts from the first plane, or, where it begins with that plane's z, from the origin.
std::vector<double> dose_heights(DcmDataset& dataset, const SlicePlacement& first, std::int64_t frames) {
    if (frames == 1) return {0};
    std::vector<double> offsets = dcmtk::decimals(dataset, DCM_GridFrameOffsetVector);
    if (static_cast<std::int64_t>(offsets.size()) != frames)
        throw corrupt("it has " + std::to_string(frames) + " frames, and " + dcmtk::tag_name(DCM_GridFrameOffsetVector) +
                      " has " + std::to_string(offsets.size()) + " values");
    constexpr double kSameMm = 1e-3, kAxial = 1e-4;
    if (std::abs(offsets.front()) <= kSameMm) return offsets;
    const double upwards = first.normal().z;
    if (std::abs(std::abs(upwards) - 1) > kAxial || std::abs(offsets.front() - first.position.z) > kSameMm)
        throw corrupt(dcmtk::tag_name(DCM_GridFrameOffsetVector) +
                      " begins neither with 0 nor with the z of an axial plane");
    for (double& offset : offsets) offset = (offset - first.position.z) * (upwards > 0 ? 1 : -1);
    return offsets;
}

/// The planes of a dose grid, in the unit of the dose.
std::vector<DicomHeader> read_dose_planes(DicomHeader header, DcmDataset& dataset) {
    const double scaling = dcmtk::first_decimal(dataset, DCM_DoseGridScaling).value_or(0);
    if (!(scaling > 0) || !std::isfinite(scaling))
        throw corrupt(dcmtk::tag_name(DCM_DoseGridScaling) + " is missing or not positive");
    header.rescale = {scaling, 0};
    header.placement = dcmtk::read_placement(dataset, dataset, dataset);
    header.dose = dcmtk::text(dataset, DCM_DoseType) + " " + dcmtk::text(dataset, DCM_DoseSummationType);
    header.dose_unit = dcmtk::text(dataset, DCM_DoseUnits);
    std::vector<DicomHeader> planes;
    const SlicePlacement first = header.placement;
    for (const double height : dose_heights(dataset, first, header.frames)) {
        header.placement.position = first.position + height * first.normal();
        if (header.frames > 1) header.frame = static_cast<std::int64_t>(planes.size()) + 1;
        planes.push_back(header);
    }
    // Several grids of one series are told apart by their files; planes in files of their own belong together.
    if (planes.size() > 1)
        for (DicomHeader& plane : planes) plane.dose += " in " + plane.path.filename().string();
    return planes;
}

std::vector<DicomHeader> read_slices(const std::filesystem::path& path, DcmFileFormat& file) {
    DcmDataset& dataset = *file.getDataset();
    DicomHeader header = read_image_header(path, file);
    if (header.modality == "RTDOSE") return read_dose_planes(std::move(header), dataset);
    if (!has_placed_frames(dataset)) {
        if (dcmtk::text(dataset, DCM_ImageType).find("MOSAIC") != std::string::npos)
            throw Error(ErrorKind::unsupported,
                        "it is a Siemens mosaic, many slices in one image; convert it with dcm2niix first");
        header.placement = dcmtk::read_placement(dataset, dataset, dataset);
        return {std::move(header)};
    }
    const std::vector<dcmtk::Frame> frames = dcmtk::frames_of(dataset);
    std::vector<DicomHeader> slices;
    for (const dcmtk::Frame& frame : frames) {
        const auto number = static_cast<std::int64_t>(slices.size()) + 1;
        try {
            slices.push_back(read_frame_header(header, frame, number));
        } catch (const Error& error) {
            throw error.with_context("frame " + std::to_string(number));
        }
    }
    return slices;
}

/// nullopt for an image that can be placed in space.
std::optional<NotAnImage> reason_to_skip(DcmDataset& dataset) {
    std::string modality = dcmtk::text(dataset, DCM_Modality);
    if (modality == "SEG") return NotAnImage{modality};
    if (!dataset.tagExists(DCM_Rows))
        return NotAnImage{modality.empty() ? "DICOM without an image" : modality, "it has no pixels"};
    if (has_placed_frames(dataset)) return std::nullopt;
    const std::string missing = missing_for_place(dataset);
    const bool several = modality != "RTDOSE" && dcmtk::integer(dataset, DCM_NumberOfFrames).value_or(1) > 1;
    if (several) return NotAnImage{"frames without a position in space", missing};
    if (missing.empty()) return std::nullopt;
    return NotAnImage{"image without a position in space", missing};
}

/// What is left of a file that cannot be parsed to its pixels.
DamagedImage damaged_image(const std::filesystem::path& path, const Error& error) {
    std::optional<std::string> series;
    try {
        DcmFileFormat file;
        dcmtk::load(file, path, DCM_StudyID);  // the element after SeriesInstanceUID
        series = dcmtk::text(*file.getDataset(), DCM_SeriesInstanceUID);
    } catch (const Error& again) {
        if (again.kind() == ErrorKind::io) throw;
    }
    if (series && series->empty()) series.reset();
    return {path, series, error};
}

}  // namespace

std::string name_of(const DicomHeader& slice) {
    const std::string name = slice.path.filename().string();
    return slice.frame ? name + ", frame " + std::to_string(*slice.frame) : name;
}

std::variant<std::vector<DicomHeader>, NotAnImage, DamagedImage> read_dicom_headers(const std::filesystem::path& path) {
    if (!has_dicom_prefix(path)) return NotAnImage{"not a DICOM file", "", false};
    DcmFileFormat file;
    try {
        dcmtk::load(file, path, DCM_PixelData);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::io) throw;
        return damaged_image(path, error);
    }
    DcmDataset& dataset = *file.getDataset();
    try {
        if (auto reason = reason_to_skip(dataset)) return std::move(*reason);
        return read_slices(path, file);
    } catch (const Error& error) {
        return DamagedImage{path, dcmtk::text(dataset, DCM_SeriesInstanceUID), error.with_context(path.string())};
    }
}

}  // namespace kontur
