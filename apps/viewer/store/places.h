// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "kontur/base/error.h"

namespace kontur::viewer {

/// There is nothing at a path within the places.
class PathMissing : public Error {
public:
    using Error::Error;
};

/// A folder that a page may start from.
struct Place {
    std::string name;
    std::filesystem::path path;
};

/// The folders that a page may look into and open images from, with all below them: whoever has the page can see no more of
/// the disk. Hidden files and folders, and links that lead out, are neither listed nor opened.
class Places {
public:
    /// What is no folder that can be read is left out.
    explicit Places(const std::vector<Place>& places = {});

    const std::vector<Place>& all() const { return places_; }

    /// The path without links. Throws Error(io) for what is not there, Error(invalid_input) for what lies outside of all
    /// places or is hidden.
    std::filesystem::path resolved(const std::string& path) const;

    /// The folder to go back to from a path: itself, or the one that it lies in; "" where that is not in the places.
    std::string folder_of(const std::string& path) const;

    /// What can be opened in a folder, as docs/viewer-protocol.md has it: folders, images and projects, and whether there
    /// are DICOM images in it or below it. Throws as `resolved`, and Error(io) for what is no folder or cannot be read.
    nlohmann::json list(const std::string& folder) const;

private:
    nlohmann::json parent_json(const std::filesystem::path& folder) const;

    std::vector<Place> places_;
};

/// The user's home, the folder that kontur was started in, and where disks of others are mounted.
std::vector<Place> usual_places();

}  // namespace kontur::viewer
