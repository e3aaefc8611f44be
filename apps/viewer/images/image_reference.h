// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/io/images/read_image_options.h"

namespace kontur::viewer {

/// Which of the volumes of a path; nothing where there is only one.
struct ImageChoice {
    std::optional<std::string> series_uid{};
    std::optional<int> volume{};             ///< of the series, from 1
    std::optional<std::int64_t> frame{};     ///< from 1
    std::optional<NiftiTransform> prefer{};  ///< of two that differ
    bool resample_slices = false;            ///< of a series, where they lie unevenly

    friend bool operator==(const ImageChoice&, const ImageChoice&) = default;
};

/// Where an image of a project is, and which one it is.
struct ImageReference {
    std::string path;         ///< where it was, or "phantom"
    std::string fingerprint;  ///< of its geometry and voxels
    ImageChoice choice{};

    friend bool operator==(const ImageReference&, const ImageReference&) = default;
};

/// A project's image is not where it was.
class ImageNotFound : public Error {
public:
    ImageNotFound(const std::string& sentence, std::string image)
        : Error(ErrorKind::io, sentence), image_(std::move(image)) {}
    const std::string& image() const { return image_; }

private:
    std::string image_;
};

// As requests and project files have them: members `series`, `volume`, `frame`, `prefer`, `resample_slices`, beside a
// reference's `path` and `fingerprint`. Reading throws Error(invalid_input) as `Members` does.

nlohmann::json to_json(const ImageChoice& choice);
nlohmann::json to_json(const ImageReference& reference);
ImageChoice choice_from_json(const nlohmann::json& object);
ImageReference reference_from_json(const nlohmann::json& object);

}  // namespace kontur::viewer
