// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "archive/http.h"
#include "kontur/io/dicom/dicom_object.h"

// STOW-RS: objects are stored in an archive (DICOM PS3.18, 10.5).

namespace kontur::archive {

enum class Outcome {
    stored,
    stored_with_doubt,  ///< with a warning, or elements changed
    was_there,          ///< and stays as it is: nothing was sent
    refused,
};

struct Sent {
    Outcome outcome = Outcome::stored;
    std::string reason;  ///< what the archive says of it, where it says something
};

/// Stores one file as a new object of its study, which the archive must have: nothing is ever sent for an object that is
/// there. What the archive answers is the result, one way or the other. Throws what Http throws, Error(invalid_input) where
/// the archive does not have the study, and what `refusal` says of answers without a word on the object.
Sent send_object(Http& http, const std::filesystem::path& file, const DicomObject& object, const Work& work);

}  // namespace kontur::archive
