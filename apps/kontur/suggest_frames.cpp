// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "facts.h"
#include "kontur/base/error.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/suggest_moving.h"
#include "moving_input.h"
#include "outputs.h"
#include "suggest.h"

// Where to draw next of what moves: which frame, and which plane.

namespace kontur::app {
namespace {

[[noreturn]] void refuse(const std::string& problem) { throw Error(ErrorKind::invalid_input, problem); }

void check(const SuggestCommand& command) {
    check_moving_image(command.image);
    if (!command.output.empty()) refuse("--output has no room for frames, and contours were drawn in several; --sketch has");
    if (!command.empty_planes.empty())
        refuse("--empty-planes are of one moment, and contours were drawn at several; leave it out");
}

/// "; 61.2 ml there (55 to 68)".
std::string volume_text(const VolumeCurve& curve, std::size_t frame) {
    std::string text = fmt::format("; {:.4g} ml there", curve.volumes_ml[frame]);
    if (curve.intervals.empty()) return text;
    const VolumeInterval& interval = curve.intervals[frame];
    return text + fmt::format(" ({:.3g} to {:.3g})", interval.low_ml, interval.high_ml);
}

Facts facts_of(const MovingSuggestion& one, const VolumeCurve& curve) {
    Facts facts{{"frame", one.frame + 1},
                {"origin_mm", triple(one.plane.origin)},
                {"normal", triple(one.plane.normal)},
                {"volume_ml", curve.volumes_ml[one.frame]}};
    if (one.slice) facts["slice"] = app::facts_of(*one.slice);
    if (!curve.intervals.empty()) {
        facts["volume_low_ml"] = curve.intervals[one.frame].low_ml;
        facts["volume_high_ml"] = curve.intervals[one.frame].high_ml;
    }
    return facts;
}

/// With the moments in which they are to be drawn.
ContourSet sketches(const std::vector<MovingSuggestion>& found, const MovingSegmentation& moving, const ContourSet& drawn) {
    ContourSet all = sketch_of({}, {}, drawn);
    all.cycle_frames = drawn.cycle_frames;
    all.cycle_s = drawn.cycle_s;
    const bool in_seconds = drawn.contours.front().time_s.has_value();
    for (const MovingSuggestion& one : found)
        for (Contour& contour : sketch_of({one.plane}, moving.meshes[one.frame], drawn).contours) {
            (in_seconds ? contour.time_s : contour.frame) = moving.times[one.frame];
            all.contours.push_back(std::move(contour));
        }
    return all;
}

}  // namespace

void run_for_frames(const SuggestCommand& command, ReadContours read, Console& console) {
    check(command);
    const Work work = console.work(command.threads);
    ContourSet& contours = read.contours;
    const MovingInput input = read_moving_input({command.image, command.cycle, read.frame_of_reference_uid}, contours, work);
    for (const std::vector<std::string>& notes : {read.notes, input.notes})
        for (const std::string& note : notes) console.warn(note);
    SegmentOptions options = command.options;
    options.drawn_on = input.grid;
    options.mesh = !command.sketch.empty();
    const MovingSegmentation moving =
        segment_moving(contours, input.to_segment(command.image, work), input.times, options, work);
    for (const std::string& warning : moving.warnings) console.warn(warning);
    const auto skip = static_cast<std::size_t>(command.skip);
    std::vector<MovingSuggestion> found =
        suggest_moving({moving.times, moving.volumes, moving.function, moving.moments},
                       skip + static_cast<std::size_t>(command.planes), {.planes = command.among, .grid = input.grid}, work);
    found.erase(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(std::min(skip, found.size())));

    Outputs outputs;
    if (!command.sketch.empty())
        outputs.write(command.sketch, [&](const std::filesystem::path& path) {
            write_contour_json(path, sketches(found, moving, contours));
        });
    outputs.commit();
    if (found.size() < static_cast<std::size_t>(command.planes))
        console.warn(fmt::format("{} of {} planes are suggested: little is left to be told in other frames", found.size(),
                                 command.planes));
    if (command.json) {
        Facts list = Facts::array();
        for (const MovingSuggestion& one : found) list.push_back(facts_of(one, moving.volumes));
        return console.print(to_json_text(Facts{{"planes", list}}));
    }
    std::string text;
    for (std::size_t n = 0; n < found.size(); ++n)
        text += line_of(n + 1, found[n].plane, found[n].slice) + fmt::format(", frame {}", found[n].frame + 1) +
                volume_text(moving.volumes, found[n].frame) + "\n";
    console.print(text);
}

}  // namespace kontur::app
