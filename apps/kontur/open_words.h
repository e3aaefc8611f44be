// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "commands.h"
#include "kontur/base/work.h"
#include "viewer/images/image_reference.h"

// What the words of `kontur open`, or of a page, name.

namespace kontur::app {

inline constexpr const char* kProjectExtension = ".kontur";

/// The command's words by what they name; "phantom" where no file has this name is the example.
struct Words {
    std::filesystem::path image, contours, project;

    bool is_empty() const { return image.empty() && contours.empty() && project.empty(); }
    /// For people.
    std::string title() const;
};

/// An existing `--project` alone is such a word, too. Throws Error(io) for what is not there, Error(invalid_input) for two
/// of a kind, and for a new project alone.
Words sorted_words(const OpenCommand& command);

/// Where a structure set or a segmentation is named alone, with the images that it was drawn on, which lie near it;
/// `command` then says which of them. A segmentation without images stays an image itself. Throws Error(invalid_input) for a
/// structure set without.
Words with_images(const Words& words, const Work& work, OpenCommand& command);

/// Which of a path's volumes options choose, and back: a 4D file or a folder of several volumes is the same one when the
/// project is opened again.
viewer::ImageChoice choice_of(const ReadImageOptions& options);
void choose(ReadImageOptions& options, const viewer::ImageChoice& choice);

}  // namespace kontur::app
