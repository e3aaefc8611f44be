// SPDX-License-Identifier: Apache-2.0
#include "moving_input.h"

#include <fmt/format.h>

#include <algorithm>

#include "dicom_output.h"
#include "kontur/base/error.h"
#include "kontur/io/image.h"
#include "kontur/io/image_frames.h"

namespace kontur::app {
namespace {

[[noreturn]] void refuse(const std::string& problem) { throw Error(ErrorKind::invalid_input, problem); }

void choose_cycle(const MovingWords& words, ContourSet& contours, MovingInput& input) {
    const bool in_seconds = contours.contours.front().time_s.has_value();
    std::optional<double>& cycle = in_seconds ? contours.cycle_s : contours.cycle_frames;
    if (words.cycle) cycle = words.cycle;
    if (cycle || !input.frames.cycle_frames()) return;
    cycle = in_seconds ? input.frames.cycle_s : input.frames.cycle_frames();
    input.notes.push_back(fmt::format("the motion repeats after {:.4g} {}, as {} says; --cycle says otherwise", *cycle,
                                      in_seconds ? "s" : "frames", words.image.path.string()));
}

std::vector<double> times_of(const MovingWords& words, const ContourSet& contours, const ImageFrames& frames) {
    const bool in_seconds = contours.contours.front().time_s.has_value();
    if (in_seconds && frames.count > 1 && !frames.step_s)
        refuse(fmt::format("contours have a time_s, and {} does not say how far apart its frames are; give contours a frame",
                           words.image.path.string()));
    std::vector<double> times;
    for (std::int64_t n = 0; n < frames.count; ++n)
        times.push_back(in_seconds ? static_cast<double>(n) * frames.step_s.value_or(0) : static_cast<double>(n + 1));
    return times;
}

}  // namespace

FramesToSegment MovingInput::to_segment(const ImageInput& image, const Work& work) const {
    return {grid, [this, &image, work](double time) -> std::shared_ptr<const Image> {
                const auto found = std::ranges::find(times, time);
                if (found == times.end()) return nullptr;
                const ImageInput one = source_of_frame(image, frames, found - times.begin() + 1);
                return std::make_shared<const Image>(read_image(one.path, one.options, work));
            }};
}

MovingInput read_moving_input(const MovingWords& words, ContourSet& contours, const Work& work) {
    MovingInput input;
    ImageInput heard = words.image;
    heard.options.on_note = [&](std::string_view note) { input.notes.emplace_back(note); };
    input.frames = read_image_frames(heard.path, heard.options, work);
    if (!input.frames.order.empty())
        input.notes.push_back(fmt::format("{}: {}", words.image.path.string(), input.frames.order));
    const ImageInput first = source_of_frame(words.image, input.frames, 1);
    for (std::string& note : frame_of_reference_notes(words.frame_of_reference_uid, first))
        input.notes.push_back(std::move(note));
    heard = source_of_frame(heard, input.frames, 1);
    input.grid = read_grid(heard.path, heard.options, work);
    choose_cycle(words, contours, input);
    input.times = times_of(words, contours, input.frames);
    return input;
}

void check_moving_image(const ImageInput& image) {
    if (image.path.empty()) refuse("contours were drawn at several moments; give a 4D --image, whose frames get masks");
    if (const auto& frame = image.options.frame)
        refuse(fmt::format("--frame {} chooses one frame, and contours were drawn in several; leave it out", *frame));
    if (const auto& volume = image.options.dicom.volume)
        refuse(fmt::format("--volume {} chooses one volume, and contours were drawn in several; leave it out", *volume));
}

}  // namespace kontur::app
