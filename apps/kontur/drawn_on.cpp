// SPDX-License-Identifier: Apache-2.0
#include "drawn_on.h"

#include <fmt/format.h>

#include <utility>

#include "kontur/base/error.h"
#include "kontur/io/image.h"

namespace kontur::app {

DrawnOn read_drawn_on(const ImageInput& input, UseImage use, const Work& work, std::vector<std::string>& notes) {
    std::string why;
    if (use != UseImage::off) {
        try {
            std::vector<std::string> said;
            ReadImageOptions read = input.options;
            read.on_note = [&](std::string_view note) { said.emplace_back(note); };
            Image image = read_image(input.path, read, work);
            notes.insert(notes.end(), said.begin(), said.end());
            Grid grid = image.grid;
            return {std::move(grid), std::move(image)};
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            why = error.what();
        }
    }
    ReadImageOptions read = input.options;
    read.on_note = [&](std::string_view note) { notes.emplace_back(note); };
    Grid grid = read_grid(input.path, read, work);
    if (!why.empty()) notes.push_back(fmt::format("the image was not used between the contours: {}", why));
    return {std::move(grid), {}};
}

}  // namespace kontur::app
