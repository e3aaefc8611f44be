// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "commands.h"
#include "kontur/base/error.h"
#include "kontur/base/work.h"
#include "open_image.h"
#include "open_words.h"
#include "viewer/server/workspace.h"
#include "viewer/session/session.h"

// What `kontur open` works on: an image with its project, from the words of the command or of a page.

namespace kontur::app {

/// A session, and what the user should know of how it came to be.
struct ProjectSession {
    std::shared_ptr<viewer::Session> session;
    Messages messages;
};

/// About the second image that the command names: with the first one all may be well.
class SecondImageError : public Error {
public:
    explicit SecondImageError(const Error& error) : Error(error.with_context("--second-image")) {}
};

/// Reads the image and opens, or makes, the project, with its second image: one that cannot be read, or does not fit, is an
/// `SecondImageError` where the command names it, and a warning where the project does. Other errors are those of the
/// readers and of `Session`.
ProjectSession open_project(const OpenCommand& command, const Words& words, const Work& work);

/// The same for a page.
std::shared_ptr<viewer::Session> open_project(const viewer::OpenRequest& request, const Work& work);

/// An image that a page asks to see beside the one that is open.
viewer::OpenedImage read_second_image(const viewer::OpenRequest& request, const Work& work);

/// Where the viewer keeps a file of its own, such as the list of recent projects; "" without a home folder.
std::filesystem::path viewer_file(std::string_view name);

}  // namespace kontur::app
