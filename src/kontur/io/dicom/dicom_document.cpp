// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/dicom/dicom_names.h"
#include "kontur/io/dicom/dicom_uid.h"

namespace kontur::dcmtk {
namespace {

/// What an object made from images inherits from them. Those of type 2 are written empty where the images lack them.
const std::array kPatientAndStudy{
    DCM_PatientName, DCM_PatientID, DCM_PatientBirthDate, DCM_PatientSex,      DCM_StudyInstanceUID,
    DCM_StudyDate,   DCM_StudyTime, DCM_StudyID,          DCM_AccessionNumber, DCM_ReferringPhysicianName};
const std::array kInheritedIfPresent{DCM_PatientAge,
                                     DCM_PatientSize,
                                     DCM_PatientWeight,
                                     DCM_StudyDescription,
                                     DCM_PatientIdentityRemoved,
                                     DCM_DeidentificationMethod};

void must(const OFCondition& condition, const DcmTagKey& tag) {
    if (condition.bad()) throw std::logic_error(tag_name(tag) + " cannot be set: " + condition.text());
}

void put_now(DcmItem& item, const DcmTagKey& date_tag, const DcmTagKey& time_tag) {
    OFString date, time;
    DcmDate::getCurrentDate(date);
    DcmTime::getCurrentTime(time, /*seconds=*/OFTrue, /*fraction=*/OFFalse);
    put(item, date_tag, date.c_str());
    put(item, time_tag, time.c_str());
}

}  // namespace

void put(DcmItem& item, const DcmTagKey& tag, const std::string& text) {
    must(item.putAndInsertOFStringArray(tag, OFString(text.data(), text.size())), tag);
}

void put(DcmItem& item, const DcmTagKey& tag, std::int64_t number) {
    const DcmVR vr = DcmTag(tag).getVR();
    if (vr.getEVR() == EVR_US) must(item.putAndInsertUint16(tag, static_cast<Uint16>(number)), tag);
    else if (vr.getEVR() == EVR_UL) must(item.putAndInsertUint32(tag, static_cast<Uint32>(number)), tag);
    else put(item, tag, std::to_string(number));
}

DcmItem& append_item(DcmItem& item, const DcmTagKey& sequence) {
    constexpr long kNewAtEnd = -2;
    DcmItem* added = nullptr;
    must(item.findOrCreateSequenceItem(sequence, added, kNewAtEnd), sequence);
    return *added;
}

std::string one_value(std::string_view text, std::size_t max_characters) {
    std::string value;
    std::size_t characters = 0;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool starts_character = (byte & 0xC0) != 0x80;
        if (starts_character && characters++ == max_characters) break;
        value += c == '\\' ? '/' : byte < 0x20 || byte == 0x7F ? ' ' : c;
    }
    return value;
}

void put_code(DcmItem& item, const DcmTagKey& sequence, const Code& code) {
    DcmItem& entry = append_item(item, sequence);
    put(entry, DCM_CodeValue, code.value);
    put(entry, DCM_CodingSchemeDesignator, code.scheme);
    put(entry, DCM_CodeMeaning, code.meaning);
}

void start_document(DcmItem& document, const DicomSeries& images, const DocumentKind& kind) {
    DcmFileFormat file;
    load(file, images.files.front(), DCM_PixelData);
    DcmItem& source = *file.getDataset();
    put(document, DCM_SpecificCharacterSet, "ISO_IR 192");
    for (const DcmTagKey& tag : kPatientAndStudy) put(document, tag, text(source, tag));
    for (const DcmTagKey& tag : kInheritedIfPresent)
        if (source.tagExistsWithValue(tag)) put(document, tag, text(source, tag));
    put(document, DCM_FrameOfReferenceUID,
        images.frame_of_reference_uid.empty() ? new_uid() : images.frame_of_reference_uid);
    put(document, DCM_PositionReferenceIndicator, text(source, DCM_PositionReferenceIndicator));

    put(document, DCM_SOPClassUID, kind.class_uid);
    put(document, DCM_SOPInstanceUID, new_uid());
    put(document, DCM_SeriesInstanceUID, new_uid());
    put(document, DCM_Modality, kind.modality);
    put(document, DCM_SeriesDescription, one_value(kind.series_description, 64));
    put(document, DCM_OperatorsName, "");
    put(document, DCM_InstanceNumber, 1);
    put_now(document, DCM_InstanceCreationDate, DCM_InstanceCreationTime);
    put_now(document, DCM_SeriesDate, DCM_SeriesTime);
    const std::int64_t time_of_day = std::max<std::int64_t>(1, std::stoll(text(document, DCM_SeriesTime)));
    put(document, DCM_SeriesNumber, kind.series_number > 0 ? kind.series_number : time_of_day);
    put(document, DCM_Manufacturer, "kontur");
    put(document, DCM_ManufacturerModelName, "kontur");
    put(document, DCM_DeviceSerialNumber, "0");
    put(document, DCM_SoftwareVersions, KONTUR_VERSION);
}

std::string description_with_names(const std::string& given, const std::string& kind,
                                   const std::vector<std::string>& names) {
    if (given != kind) return given;
    OFString date;
    DcmDate::getCurrentDate(date);
    const std::string day(date.c_str());
    constexpr std::size_t kMostBytes = 64;  // the standard counts characters, validators count bytes
    std::string description =
        fmt::format("{} {}-{}-{}: {}", kind, day.substr(0, 4), day.substr(4, 2), day.substr(6), fmt::join(names, ", "));
    if (description.size() > kMostBytes) {
        std::size_t end = kMostBytes;
        while ((static_cast<unsigned char>(description[end]) & 0xC0) == 0x80) --end;  // within a character
        description.resize(end);
    }
    return description;
}

void put_contribution(DcmItem& document, const Provenance& provenance) {
    if (provenance.empty()) return;
    std::string text;
    for (const auto& [name, value] : provenance) {
        text += (text.empty() ? "" : "; ") + name + ": ";
        for (const char c : value) text.append(c == ';' ? 2 : 1, c);
    }
    DcmItem& item = append_item(document, DCM_ContributingEquipmentSequence);
    put_code(item, DCM_PurposeOfReferenceCodeSequence, {"109103", "DCM", "Modifying Equipment"});
    put(item, DCM_Manufacturer, "kontur");
    put(item, DCM_ManufacturerModelName, "kontur");
    put(item, DCM_SoftwareVersions, KONTUR_VERSION);
    put(item, DCM_ContributionDescription, one_value(text, kMostTextCharacters));
}

void put_file_reference(DcmItem& item, const DicomHeader& slice) {
    put(item, DCM_ReferencedSOPClassUID, slice.sop_class_uid);
    put(item, DCM_ReferencedSOPInstanceUID, slice.sop_instance_uid);
}

void put_image_reference(DcmItem& item, const DicomHeader& slice) {
    put_file_reference(item, slice);
    if (slice.frame) put(item, DCM_ReferencedFrameNumber, *slice.frame);
}

void save(DcmFileFormat& file, const std::filesystem::path& path, E_TransferSyntax syntax) {
    AtomicFile target(path);
    const OFCondition saved = file.saveFile(OFFilename(target.temporary_path().c_str()), syntax);
    if (saved.bad()) throw Error(ErrorKind::io, "cannot write " + path.string() + ": " + saved.text());
    target.commit();
}

}  // namespace kontur::dcmtk

namespace kontur {
namespace {

std::vector<DicomHeader> slices_of_file(const std::filesystem::path& path) {
    auto content = read_dicom_headers(path);
    if (const auto* damaged = std::get_if<DamagedImage>(&content)) throw damaged->error;
    auto* slices = std::get_if<std::vector<DicomHeader>>(&content);
    if (!slices || slices->front().sop_class_uid.empty() || slices->front().sop_instance_uid.empty() ||
        slices->front().series_uid.empty())
        throw Error(ErrorKind::invalid_input,
                    path.string() + " lacks the identifiers by which a DICOM object refers to an image");
    return std::move(*slices);
}

}  // namespace

std::vector<DicomHeader> read_slice_headers(const DicomSeries& images) {
    if (images.files.empty()) throw Error(ErrorKind::invalid_input, "the image series has no files");
    std::map<std::filesystem::path, std::vector<DicomHeader>> slices_of;
    std::vector<DicomHeader> headers;
    for (std::size_t k = 0; k < images.files.size(); ++k) {
        const std::filesystem::path& path = images.files[k];
        if (!slices_of.contains(path)) slices_of[path] = slices_of_file(path);
        const auto frame = static_cast<std::size_t>(k < images.frames.size() ? images.frames[k] : 1);
        if (frame < 1 || frame > slices_of[path].size())
            throw Error(ErrorKind::invalid_input, path.string() + " has no frame " + std::to_string(frame));
        headers.push_back(slices_of[path][frame - 1]);
    }
    return headers;
}

}  // namespace kontur
