// SPDX-License-Identifier: Apache-2.0
#include "kontur/evidence.h"
#include "kontur/sureness/suggest_plane.h"

#include <fmt/format.h>

#include <array>

#include "commands.h"
#include "contour_files.h"
#include "dicom_output.h"
#include "drawn_on.h"
#include "facts.h"
#include "input_digests.h"
#include "kontur/base/error.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/sureness/surface_evidence.h"
#include "kontur/view/outline.h"
#include "outputs.h"
#include "suggest.h"

namespace kontur::app {
namespace {

/// Without an image: voxels of which so many go along the contours' box.
constexpr double kVoxelsAcross = 64;

/// Whatever can be refused before any work is done.
void check(const SuggestCommand& command) {
    std::vector<std::filesystem::path> inputs = command.contours;
    inputs.push_back(command.image.path);
    inputs.push_back(command.empty_planes);
    inputs.push_back(command.mask);
    for (const std::filesystem::path& path : {command.output, command.sketch})
        if (!path.empty() && !has_extension(path, ".json"))
            throw Error(ErrorKind::unsupported, fmt::format("{} does not end with .json", path.string()));
    check_outputs(std::array{command.output, command.sketch}, inputs);
    if (command.among == PlaneChoice::image_slices && command.image.path.empty())
        throw Error(ErrorKind::invalid_input, "slices of an image are asked for; give --image");
}

Grid grid_around_contours(const ContourSet& contours) {
    const Box3 box = bounding_box(contours);
    const double spacing = box.diagonal() / kVoxelsAcross;
    return grid_around(box, {spacing, spacing, spacing}, 0.35 * box.diagonal());
}

Facts interval(const ExpectedDice& dice) { return {{"value", dice.value}, {"low", dice.low}, {"high", dice.high}}; }

Facts facts_of(const SuggestedPlane& one) {
    Facts facts{{"origin_mm", triple(one.plane.origin)}, {"normal", triple(one.plane.normal)}, {"gain", one.gain}};
    if (one.slice) facts["slice"] = app::facts_of(*one.slice);
    if (one.after.value > 0) {
        facts["expected_dice"] = interval(one.before);
        facts["expected_dice_with_it"] = interval(one.after);
    }
    return facts;
}

std::string line_of(std::size_t number, const SuggestedPlane& one) {
    std::string text = app::line_of(number, one.plane, one.slice);
    if (one.after.value > 0)
        text += fmt::format("; expected Dice {:.2f}, with it {:.2f}", one.before.value, one.after.value);
    return text + "\n";
}

/// One after another, each the best but for those before it.
std::vector<Plane> skipped(int count, const SurfaceEvidence& evidence, const ContourSet& contours,
                           SuggestPlaneOptions options, const Work& work) {
    for (int n = 0; n < count; ++n) {
        const PlaneSuggestions best = suggest_planes(evidence, contours, 1, options, work);
        if (best.planes.empty()) break;
        options.avoid.push_back(best.planes.front().plane);
    }
    return std::move(options.avoid);
}

/// The image's grid, and its voxels where they are asked; without one a grid of the contours' own.
DrawnOn drawn_on(const SuggestCommand& command, const ContourSet& contours, const Work& work, Console& console) {
    if (command.image.path.empty()) return {grid_around_contours(contours), {}};
    std::vector<std::string> notes;
    DrawnOn drawn_on = read_drawn_on(command.image, command.options.use_image, work, notes);
    for (const std::string& note : notes) console.warn(note);
    return drawn_on;
}

}  // namespace

ContourSet sketch_of(const std::vector<Plane>& planes, const TriangleMesh& mesh, const ContourSet& drawn) {
    ContourSet sketch;
    sketch.name = drawn.name;
    sketch.attributes = drawn.attributes;
    for (const Plane& plane : planes)
        for (Polyline& line : outline(mesh, plane))
            if (line.closed && line.points.size() >= 3) {
                for (Vec3& p : line.points) p -= plane.distance_to(p) * plane.normal;
                sketch.contours.push_back({.plane = plane, .points = std::move(line.points)});
            }
    return sketch;
}

Facts triple(const Vec3& v) { return {v.x, v.y, v.z}; }

std::string line_of(std::size_t number, const Plane& plane, const std::optional<ImageSlice>& slice) {
    const Vec3 &at = plane.origin, &n = plane.normal;
    std::string text = fmt::format("{}: through ({:.1f}, {:.1f}, {:.1f}) mm, across ({:.3f}, {:.3f}, {:.3f})", number, at.x,
                                   at.y, at.z, n.x, n.y, n.z);
    if (slice) text += fmt::format(", slice {} = {}", "ijk"[slice->axis], slice -> index);
    return text;
}

Facts facts_of(const ImageSlice& slice) { return {{"axis", std::string(1, "ijk"[slice.axis])}, {"index", slice.index}}; }

void run(const SuggestCommand& command, Console& console) {
    check(command);
    if (!command.mask.empty()) return run_for_mask(command, console);
    ReadContours read = read_contours_to_fit(command.contours, command.read);
    if (kontur::is_moving(read.contours)) return run_for_frames(command, std::move(read), console);
    if (command.cycle) throw Error(ErrorKind::invalid_input, "--cycle is for contours that were drawn at several moments");
    const Work work = console.work(command.threads);
    for (const std::string& note : read.notes) console.warn(note);
    ContourSet& contours = read.contours;
    if (!command.empty_planes.empty())
        for (const Plane& plane : read_planes_json(command.empty_planes)) contours.empty_planes.push_back(plane);
    const auto [grid, image] = drawn_on(command, contours, work, console);

    SegmentOptions options = command.options;
    options.mesh = !command.sketch.empty();
    if (!command.image.path.empty()) options.drawn_on = grid;
    const Segmentation segmentation = segment(contours, grid, image ? &*image : nullptr, options, work);
    for (const std::string& warning : segmentation.report.warnings) console.warn(warning);
    SuggestPlaneOptions choose{.planes = command.among};
    if (!command.image.path.empty()) choose.grid = grid;
    const SurfaceEvidence evidence = gather_evidence(segmentation, contours, work);
    choose.avoid = skipped(command.skip, evidence, contours, choose, work);
    const PlaneSuggestions found =
        suggest_planes(evidence, contours, static_cast<std::size_t>(command.planes), choose, work);

    std::vector<Plane> planes;
    for (const SuggestedPlane& one : found.planes) planes.push_back(one.plane);
    Outputs outputs;
    if (!command.output.empty())
        outputs.write(command.output,
                      [&](const std::filesystem::path& path) { write_planes_json(path, planes, contours.name); });
    if (!command.sketch.empty())
        outputs.write(command.sketch, [&](const std::filesystem::path& path) {
            write_contour_json(path, sketch_of(planes, *segmentation.mesh, contours));
        });
    outputs.commit();

    const std::string about = sentence(segmentation.report.uncertainty);
    const ImageReport& report = segmentation.report.image;
    if (found.planes.size() < static_cast<std::size_t>(command.planes))
        console.warn(
            fmt::format("{} of {} planes are suggested: every other one that meets the object runs along one that "
                        "was drawn, suggested or skipped",
                        found.planes.size(), command.planes));
    if (command.json) {
        Facts list = Facts::array();
        for (const SuggestedPlane& one : found.planes) list.push_back(facts_of(one));
        Facts all{{"planes", list}, {"about", about}};
        if (report.verdict != ImageVerdict::none)
            all["image"] = {{"verdict", std::string(name(report.verdict))}, {"sentence", sentence(report)}};
        console.print(to_json_text(all));
        return;
    }
    std::string text;
    for (std::size_t n = 0; n < found.planes.size(); ++n) text += line_of(n + 1, found.planes[n]);
    if (report.verdict != ImageVerdict::none) text += sentence(report) + "\n";
    console.print(text + about + "\n");
}

}  // namespace kontur::app
