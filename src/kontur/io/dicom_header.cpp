// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom_header.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "kontur/base/error.h"
#include "kontur/io/dicom_frames.h"

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

void read_transfer_syntax(const DcmXfer& syntax, DicomHeader& header) {
    header.transfer_syntax = syntax.getXferName();
    switch (syntax.getXfer()) {
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
            header.decodable = !syntax.isEncapsulated();
    }
}

/// Only for pixels that lie in the file as they are; what a compressed slice unpacks to is checked when it is decoded.
void check_pixels_fit(const DicomHeader& header, const DcmXfer& syntax, std::int64_t bits_allocated) {
    if (syntax.isEncapsulated() || syntax.getStreamCompression() != ESC_none) return;
    const auto claimed = header.frames * header.rows * header.columns * (std::min<std::int64_t>(bits_allocated, 64) / 8);
    const auto held = static_cast<std::int64_t>(std::filesystem::file_size(header.path));
    if (claimed > held)
        throw corrupt("the header claims " + std::to_string(claimed) + " bytes of pixels, the file has " +
                      std::to_string(held) + " bytes");
}

bool is_placed(DcmDataset& dataset) {
    return dataset.tagExistsWithValue(DCM_ImagePositionPatient) && dataset.tagExistsWithValue(DCM_ImageOrientationPatient) &&
           dataset.tagExistsWithValue(DCM_PixelSpacing);
}

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
DicomHeader read_image_header(const std::filesystem::path& path, DcmDataset& dataset, const DcmXfer& syntax) {
    DicomHeader header;
    header.path = path;
    header.sop_class_uid = dcmtk::text(dataset, DCM_SOPClassUID);
    header.sop_instance_uid = dcmtk::text(dataset, DCM_SOPInstanceUID);
    header.series_uid = dcmtk::text(dataset, DCM_SeriesInstanceUID);
    header.frame_of_reference_uid = dcmtk::text(dataset, DCM_FrameOfReferenceUID);
    header.modality = dcmtk::text(dataset, DCM_Modality);
    header.description = dcmtk::text(dataset, DCM_SeriesDescription);
    read_transfer_syntax(syntax, header);
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
    header.instance_number = integer_if_any(dataset, DCM_InstanceNumber);
    check_pixels_fit(header, syntax, dcmtk::integer(dataset, DCM_BitsAllocated).value_or(0));
    return header;
}

std::vector<DicomHeader> read_slices(const std::filesystem::path& path, DcmDataset& dataset) {
    DicomHeader header = read_image_header(path, dataset, DcmXfer(dataset.getOriginalXfer()));
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

/// Empty for an image that can be placed in space.
std::string reason_to_skip(DcmDataset& dataset) {
    std::string modality = dcmtk::text(dataset, DCM_Modality);
    if (modality == "SEG" || modality == "RTDOSE") return modality;
    if (!dataset.tagExists(DCM_Rows)) return modality.empty() ? "DICOM without an image" : modality;
    if (has_placed_frames(dataset)) return "";
    if (dcmtk::integer(dataset, DCM_NumberOfFrames).value_or(1) > 1) return "frames without a position in space";
    return is_placed(dataset) ? "" : "image without a position in space";
}

}  // namespace

bool has_dicom_prefix(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return false;  // opening a pipe would wait for its writer
    std::ifstream file(path, std::ios::binary);
    std::array<char, 132> start{};
    return file.read(start.data(), start.size()) && std::string_view(&start[128], 4) == "DICM";
}

namespace {

/// Starts with an element of group 2 or 8 as DICOM's first ones are: its number, then its type in two capitals.
bool looks_like_dicom_without_preamble(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 6> start{};
    if (!file.read(start.data(), start.size())) return false;
    const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
    return (start[0] == 2 || start[0] == 8) && start[1] == 0 && start[3] == 0 && is_capital(start[4]) &&
           is_capital(start[5]);
}

}  // namespace

std::string name_of(const DicomHeader& slice) {
    const std::string name = slice.path.filename().string();
    return slice.frame ? name + ", frame " + std::to_string(*slice.frame) : name;
}

std::variant<std::vector<DicomHeader>, NotAnImage, DamagedImage> read_dicom_headers(const std::filesystem::path& path) {
    if (!has_dicom_prefix(path))
        return NotAnImage{looks_like_dicom_without_preamble(path) ? "DICOM without its preamble, which is not read"
                                                                  : "not a DICOM file"};
    DcmFileFormat file;
    dcmtk::load(file, path, DCM_PixelData);
    DcmDataset& dataset = *file.getDataset();
    try {
        if (std::string reason = reason_to_skip(dataset); !reason.empty()) return NotAnImage{std::move(reason)};
        return read_slices(path, dataset);
    } catch (const Error& error) {
        return DamagedImage{path, dcmtk::text(dataset, DCM_SeriesInstanceUID), error.with_context(path.string())};
    }
}

}  // namespace kontur
