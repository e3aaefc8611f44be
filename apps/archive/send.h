// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

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

struct SentFile {
    std::filesystem::path file;
    std::string study;  ///< its address
    Sent sent;

    /// "FILE: stored in STUDY", or what else became of it.
    std::string text() const;
};

/// Stores one file as a new object of its study, which the archive must have: nothing is ever sent for an object that is
/// there. What the archive answers is the result, one way or the other. Throws what Http throws, Error(invalid_input) where
/// the archive does not have the study, and what `refusal` says of answers without a word on the object.
Sent send_object(Http& http, const std::filesystem::path& file, const DicomObject& object, const Work& work);

/// The same for several files, all of which are read before one is sent; `on_sent` is called for each that the archive has
/// now. Why others were not stored is the result, an error for each. Throws Error(cancelled), Error(corrupt_file) for a file
/// that is no DICOM object, and Error(invalid_input) where the address is not that of a service.
std::vector<Error> send_files(Http& http, const std::vector<std::filesystem::path>& files,
                              const std::function<void(const SentFile&)>& on_sent, const Work& work);

/// "1 of 2 objects were not stored; ...", of the kind of the first one.
Error not_stored(const std::vector<Error>& failures, std::size_t files);

}  // namespace kontur::archive
