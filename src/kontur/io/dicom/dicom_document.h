// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: what the DICOM objects that kontur makes have in common. Uses DCMTK's types.

#include <filesystem>
#include <string>
#include <vector>

#include "kontur/io/dicom/dcmtk.h"
#include "kontur/io/dicom/dicom_header.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/shape/provenance.h"

namespace kontur::dcmtk {

/// Sets an element from text (several values separated by '\'). Throws std::logic_error when DCMTK refuses: a wrong tag.
void put(DcmItem& item, const DcmTagKey& tag, const std::string& text);
void put(DcmItem& item, const DcmTagKey& tag, std::int64_t number);

/// A new last item of a sequence, which is made when it is not there.
DcmItem& append_item(DcmItem& item, const DcmTagKey& sequence);

/// A name or comment of the user's as one value of at most `max_characters`: backslashes, which separate values, become
/// slashes, control characters blanks; what is too long is cut at a character's end.
std::string one_value(std::string_view text, std::size_t max_characters);

/// The items of a coded concept, such as {"113076", "DCM", "Segmentation"}.
struct Code {
    const char* value;
    const char* scheme;
    const char* meaning;
};
void put_code(DcmItem& item, const DcmTagKey& sequence, const Code& code);

/// What kind of object a document is, and the series that it begins.
struct DocumentKind {
    const char* class_uid;
    const char* modality;
    std::string series_description;
    std::int64_t series_number;  ///< 0: the time of day, hhmmss
};

/// A new object of a series of its own, in UTF-8, that belongs to the patient, study and frame of reference of `images`,
/// whose first file is read for it; names kontur as its maker. The frame of reference is a new one where the images name
/// none.
void start_document(DcmItem& document, const DicomSeries& images, const DocumentKind& kind);

/// "kontur contours 2026-11-28: Liver, Spleen": what a list of results tells them apart by, in at most 64
/// bytes. A given description that is not the default kind stays as it is.
std::string description_with_names(const std::string& given, const std::string& kind, const std::vector<std::string>& names);

/// Says how the object was made: kontur as equipment that contributed to it (PS3.3 C.12.1). Nothing without provenance.
void put_contribution(DcmItem& document, const Provenance& provenance);

/// Refers to a slice's file.
void put_file_reference(DcmItem& item, const DicomHeader& slice);

/// Refers to a slice: its file, and its frame where that has several.
void put_image_reference(DcmItem& item, const DicomHeader& slice);

/// Writes the file, whole or not at all. Throws Error(io).
void save(DcmFileFormat& file, const std::filesystem::path& path, E_TransferSyntax syntax);

}  // namespace kontur::dcmtk

namespace kontur {

/// The headers of a series' slices, in the order of k. Throws what `read_dicom_headers` throws, and Error(invalid_input) for
/// a series without files or a file without identifiers.
std::vector<DicomHeader> read_slice_headers(const DicomSeries& images);

}  // namespace kontur
