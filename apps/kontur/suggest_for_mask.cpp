// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "drawn_on.h"
#include "kontur/base/error.h"
#include "kontur/correct/existing_mesh.h"
#include "kontur/correct/suggest_to_look_at.h"
#include "kontur/image/intensities.h"
#include "kontur/io/contours/contour_json.h"
#include "mask_file.h"
#include "outputs.h"
#include "suggest.h"

namespace kontur::app {
namespace {

constexpr const char* kAbout =
    "the image is unlike the mask's border there: a hint; it misses whole wrong parts, whose border looks like any other";

/// A mask as corrected so far, and the planes that were looked at.
struct MaskSoFar {
    Mask mask;
    std::vector<Plane> seen;
    ContourSet drawing;
};

Image segmented_image(const SuggestCommand& command, Console& console, const Work& work) {
    std::string unused;
    std::optional<Image> image = readable_image({command.image.path, console.noting(command.image.options)}, work, unused);
    if (!unused.empty()) throw Error(ErrorKind::unsupported, unused);
    if (is_label_map(*image))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} holds labels, which any border is like; give the image that was segmented with --image",
                                command.image.path.string()));
    return std::move(*image);
}

MaskSoFar mask_so_far(const SuggestCommand& command, const Image& image, Console& console, const Work& work) {
    CorrectCommand read;
    read.mask = {command.mask, command.image.options};
    read.image = command.image.path;
    read.label = command.label;
    MaskSoFar so_far{read_mask_file(read, console, work).mask, {}, {}};
    if (!command.contours.empty()) {
        auto [corrections, notes] = read_corrections(command.contours, command.read);
        console.note(notes);
        CorrectedMask corrected = correct({so_far.mask, ExistingSurface(so_far.mask, work), &image}, corrections, {}, work);
        for (const CorrectedPlane& plane : corrected.report.planes) so_far.seen.push_back(plane.plane);
        so_far.mask = std::move(corrected.mask);
        so_far.drawing = std::move(corrections.drawing);
    }
    if (!command.empty_planes.empty())
        for (const Plane& plane : read_planes_json(command.empty_planes)) so_far.seen.push_back(plane);
    return so_far;
}

std::string line_of(std::size_t number, const PlaneToLookAt& one) {
    return app::line_of(number, one.plane, one.slice) + fmt::format("; {:.0f} mm2 doubtful\n", one.doubtful_mm2);
}

Facts facts_of(const PlaneToLookAt& one) {
    Facts facts{
        {"origin_mm", triple(one.plane.origin)}, {"normal", triple(one.plane.normal)}, {"doubtful_mm2", one.doubtful_mm2}};
    if (one.slice) facts["slice"] = app::facts_of(*one.slice);
    return facts;
}

void write(const SuggestCommand& command, const std::vector<PlaneToLookAt>& found, const ExistingSurface& surface,
           const ContourSet& drawing, const Work& work) {
    std::vector<Plane> planes;
    for (const PlaneToLookAt& one : found) planes.push_back(one.plane);
    Outputs outputs;
    if (!command.output.empty())
        outputs.write(command.output,
                      [&](const std::filesystem::path& path) { write_planes_json(path, planes, drawing.name); });
    if (!command.sketch.empty())
        outputs.write(command.sketch, [&](const std::filesystem::path& path) {
            write_contour_json(path, sketch_of(planes, ExistingMesh(surface, work).mesh(work), drawing));
        });
    outputs.commit();
}

}  // namespace

void run_for_mask(const SuggestCommand& command, Console& console) {
    const Work work = console.work(command.threads);
    const Image image = segmented_image(command, console, work);
    const MaskSoFar so_far = mask_so_far(command, image, console, work);
    const ExistingSurface surface(so_far.mask, work);
    const auto skip = static_cast<std::size_t>(command.skip), count = static_cast<std::size_t>(command.planes);
    std::vector<PlaneToLookAt> found = suggest_to_look_at(surface, image, skip + count, {command.among, so_far.seen}, work);
    found.erase(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(std::min(skip, found.size())));
    if (found.size() < count)
        console.warn(fmt::format("{} of {} planes are suggested: the image is like the mask's border in all others",
                                 found.size(), count));
    write(command, found, surface, so_far.drawing, work);
    if (command.json) {
        Facts list = Facts::array();
        for (const PlaneToLookAt& one : found) list.push_back(facts_of(one));
        console.print(to_json_text(Facts{{"planes", list}, {"about", kAbout}}));
        return;
    }
    std::string text;
    for (std::size_t n = 0; n < found.size(); ++n) text += line_of(n + 1, found[n]);
    console.print(text + kAbout + "\n");
}

}  // namespace kontur::app
