// SPDX-License-Identifier: Apache-2.0
#include "drawn_on.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "kontur/base/error.h"

namespace kontur::app {

std::optional<Image> readable_image(const ImageInput& input, const Work& work, std::string& sentence) {
    try {
        return read_image(input.path, input.options, work);
    } catch (const Error& error) {
        std::error_code unreachable;
        const bool missing_frame = input.options.frame && error.kind() == ErrorKind::invalid_input;  // for what is not there
        if (missing_frame || error.kind() == ErrorKind::cancelled || !std::filesystem::exists(input.path, unreachable))
            throw;
        sentence = fmt::format("the image was not used between the contours: {}", error.what());
        return {};
    }
}

DrawnOn read_drawn_on(const ImageInput& input, UseImage use, const Work& work, std::vector<std::string>& notes) {
    std::string unused;
    std::vector<std::string> said;
    ImageInput heard = input;
    heard.options.on_note = [&](std::string_view note) { said.emplace_back(note); };
    std::optional<Image> image;
    if (use != UseImage::off) image = readable_image(heard, work, unused);
    if (!image) said.clear();  // they come again
    Grid grid = image ? image->grid : read_grid(heard.path, heard.options, work);
    notes.insert(notes.end(), said.begin(), said.end());
    if (!unused.empty()) notes.push_back(unused);
    return {std::move(grid), std::move(image)};
}

}  // namespace kontur::app
