// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "archive/http.h"

// WADO-RS: objects come as they are stored (DICOM PS3.18, 10.4), each into a file of its own.

namespace kontur::archive {

/// How far a series has come.
struct FetchedSeries {
    std::size_t objects = 0;  ///< that the archive lists
    std::size_t arrived = 0;  ///< of these in the folder
};

/// Where a series lies until it is whole: the folder's name and ".part".
std::filesystem::path part_folder(const std::filesystem::path& folder);

/// Fetches what is missing of a series into `part_folder(folder)`, as UID.dcm, then renames that to `folder`: this exists
/// only when whole. What came before an error stays, and the next call goes on from there; `progress` is kept true all the
/// while. A folder that is there already is looked at only: it must be empty or have all that the archive lists, else
/// Error(invalid_input).
///
/// Throws what Http throws; Error(corrupt_file) for an answer that is not in parts, for a part that is no DICOM file or no
/// object of the archive's list, and for one that comes twice; Error(too_large) for an object over 4 GiB; Error(io).
void fetch_series(Http& http, const Address& series, const std::filesystem::path& folder, FetchedSeries& progress,
                  const Work& work);

/// The same into a folder that a user named; returns how many objects it has. Where some came before an error, its sentence
/// says where they are and that the same again goes on from there. `on_interruption`, if given, gets that sentence before a
/// cancellation is thrown, and may throw something else.
std::size_t fetch_into_folder(Http& http, const Address& series, const std::filesystem::path& folder, const Work& work,
                              const std::function<void(const std::string& how_far)>& on_interruption = {});

/// One object into a file, whole or not at all; one that is there stays. Throws as `fetch_series`.
void fetch_instance(Http& http, const Address& instance, const std::filesystem::path& file, const Work& work);

}  // namespace kontur::archive
