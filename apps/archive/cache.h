// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "archive/query.h"

// What comes from archives stays on the disk: a project refers to its image, and nothing comes twice. It lies in
// $XDG_CACHE_HOME/kontur/archive (or ~/.cache), HOST/STUDY/SERIES/OBJECT.dcm, which nobody else may look into.

namespace kontur::archive {

/// A whole series: its folder, or of a series of one object that file. Throws as `fetch_series`; where something came and is
/// kept, the sentence says so.
std::filesystem::path fetch_to_cache(Http& http, const Address& series, const Work& work);

/// Where a series lies in the cache: while it comes, and whole.
std::vector<std::filesystem::path> cache_places(const Address& series);

/// Those series that hold what was drawn, into folders beside the images, where `kontur open` looks for them.
void fetch_drawings_to_cache(Http& http, const std::vector<Series>& all, const Address& study, const Work& work);

/// What a program reads of an address in place of a path: an object, a series, of a study the series `series_uid`, or
/// without one its only series of images. With `with_drawings` the study's structure sets and segmentations come, too.
/// Throws as `fetch_series`, and Error(invalid_input) for a service's address and for several series of images, which it
/// lists.
std::filesystem::path fetch_what_is_read(Http& http, Address address, const std::optional<std::string>& series_uid,
                                         bool with_drawings, const Work& work);

/// Whether a path lies among what came from this service.
bool came_from(const Address& service, const std::filesystem::path& path);

/// One object. Throws as `fetch_instance`.
std::filesystem::path fetch_object_to_cache(Http& http, const Address& instance, const Work& work);

}  // namespace kontur::archive
