// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kontur/shape/volume.h"
#include "viewer/images/opened_image.h"
#include "viewer/images/time_axis.h"
#include "viewer/images/views.h"

namespace kontur::viewer {

/// An image that is shown beside the one that a project is drawn on, and how it is shown at first.
struct FurtherImage {
    OpenedImage opened;
    std::shared_ptr<TimeAxis> times;  ///< of this image itself, where it has several volumes
    Affine3 mm_to_index;
    std::string unit;
    std::pair<double, double> range;
    Window window;
    std::vector<WindowPreset> presets;
};

FurtherImage further_image(OpenedImage opened);

/// "Doe, Jane (ID 17)"; one of the two where the file says no more, "" where it says neither.
std::string patient_words(const DicomIdentity& identity);

/// Of the values; "" where the file names none.
std::string unit_of(const DicomIdentity& identity, const Image& image);

/// Whether it counts what a tracer emits: its values begin at 0, and what is high matters.
bool is_emission(const DicomIdentity& identity);

/// From 0 to a value that one of 200 voxels has passed, of SUV to 5 at least: where nothing takes up much, healthy organs
/// are not to look as if they did. To the largest value where that one is not above 0.
Window emission_window(const Image& image, const std::string& unit);

// As docs/viewer-protocol.md has them.

nlohmann::json to_json(const DicomIdentity& identity);
nlohmann::json to_json(const std::vector<WindowPreset>& presets);
/// `number`: of the image among those of the project.
nlohmann::json to_json(const FurtherImage& further, int number);

}  // namespace kontur::viewer
