// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to io/: DCMTK set up once, and values taken strictly out of its items. Includes DCMTK; of our headers only
// dicom_document.h and dicom_frames.h do so too.

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kontur::dcmtk {

/// Registers the JPEG, JPEG-LS and RLE decoders and silences DCMTK's log. Throws Error(io) when DCMTK cannot find its data
/// dictionary, without which implicit-VR files cannot be understood. Cheap after the first call; safe from any thread.
void set_up();

/// Loads the file up to, not including, `stop` (default: all of it), with or without a preamble. One in a transfer syntax
/// that DCMTK does not know is taken for explicit little-endian elements with compressed pixels, as all the newer ones are.
/// Throws Error(io) when it cannot be opened, Error(corrupt_file) when it is truncated or malformed, and Error(unsupported),
/// naming the syntax, when an unknown one does not lie in the file as thought.
void load(DcmFileFormat& file, const std::filesystem::path& path, const DcmTagKey& stop = DCM_UndefinedTagKey);

/// The transfer syntax of a loaded file: its UID, the name that DICOM gives it or else the UID again, and whether DCMTK
/// knows it.
struct Syntax {
    std::string uid, name;
    bool known = true;
};
Syntax syntax_of(DcmFileFormat& file);

/// What leads on from a compression that is not read.
inline constexpr const char* kUncompressed = "export the images uncompressed first";

/// All values of a text element, trimmed, as valid UTF-8; "" when absent. Here and below, an element of unknown type (VR UN)
/// is what DICOM's dictionary says it is. Bytes that are no characters of the declared set,
/// or of any where none is declared, are taken for UTF-8, else for Latin-1.
std::string text(DcmItem& item, const DcmTagKey& tag);

/// The same of free text, whose lines end with '\n'.
std::string lines(DcmItem& item, const DcmTagKey& tag);

/// First value of an integer element (US, SS, IS, ...); nullopt when absent or empty. Throws Error(corrupt_file) naming the
/// element when it is no integer.
std::optional<std::int64_t> integer(DcmItem& item, const DcmTagKey& tag);

/// All values of a decimal-string element; empty when absent or empty. Throws Error(corrupt_file) naming the element.
std::vector<double> decimals(DcmItem& item, const DcmTagKey& tag);

/// The items of a sequence; empty when absent.
std::vector<DcmItem*> items(DcmItem& item, const DcmTagKey& sequence);

/// The element's name and number, such as "PixelSpacing (0028,0030)".
std::string tag_name(const DcmTagKey& tag);

}  // namespace kontur::dcmtk
