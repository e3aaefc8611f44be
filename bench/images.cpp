// SPDX-License-Identifier: Apache-2.0
// What the image between the contours is worth: structures cut by few planes, segmented without and with their image. One
// line of CSV for each drawing. bench/images.py calls it for every structure and makes the tables.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "drawn_structures.h"
#include "kontur/base/error.h"
#include "kontur/extract/find_surface.h"
#include "kontur/extract/voxelize.h"
#include "kontur/image/follow_image.h"
#include "kontur/io/image.h"
#include "kontur/measure/compare.h"
#include "kontur/phantom/random.h"
#include "kontur/pipeline.h"

namespace kontur {
namespace {

/// Of the process: others on the machine do not matter.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string scores(const Mask& mask, const Mask& truth) {
    const Comparison c = compare(mask, truth, {1});
    if (!c.surface) return fmt::format("{:.4f},,", c.dice);
    return fmt::format("{:.4f},{:.3f},{:.4f}", c.dice, c.surface->hausdorff95_mm, c.surface->mean_surface_distance_mm);
}

/// A drawing, its fit, and what the image makes of it.
class Trial {
public:
    Trial(const Structure& structure, const ContourSet& contours)
        : structure_(structure),
          drawing_(read_drawing(contours, options_.fill_rule)),
          stages_(stage_options(options_, drawing_.diameter_mm())),
          prepared_(prepare(drawing_, stages_.prepare, kAlone)),
          fitted_(fit(prepared_, stages_.fit, kAlone)) {}

    Mask mask_without() const { return mask_of(fitted_.function); }
    ImageFit with_image() const {
        return follow_image(
            {drawing_, prepared_, fitted_}, structure_.image,
            [&](const ContourSet& part) { return fit_coarsely(part, stages_, kAlone); }, {.fit = stages_.fit}, kAlone);
    }
    Mask mask_of(const ImplicitFunction& function) const {
        return fill(
            find_surface(function, structure_.truth.grid,
                         start_points(drawing_.contours, prepared_, function, *stages_.prepare.click_margin_mm), {}, kAlone),
            kAlone);
    }

private:
    const Structure& structure_;
    SegmentOptions options_;
    Drawing drawing_;
    StageOptions stages_;
    PreparedContours prepared_;
    FittedFunction fitted_;
};

void measure(const Structure& structure, const WantedDrawing& wanted) {
    const double voxel = smallest(structure.truth.grid.spacing_mm());
    const ContourSet contours = drawn(structure, wanted);
    const double start = cpu_seconds();
    const Trial trial(structure, contours);
    const double fit_seconds = cpu_seconds() - start;
    const std::string without = scores(trial.mask_without(), structure.truth);
    const double image_start = cpu_seconds();
    const ImageFit with_image = trial.with_image();
    const double seconds = cpu_seconds() - image_start;
    const ImageReport& r = with_image.report;
    fmt::print(
        "{},{},{},{},{},{:.3f},{:.3f},{:.3f},{:.4f},{:.2f},{:.2f}\n", structure.name, wanted.name(), without,
        r.verdict == ImageVerdict::used ? scores(trial.mask_of(with_image.fitted.function), structure.truth) : without,
        r.walked ? "walked" : name(r.verdict), r.error_without_mm, r.error_with_mm, r.largest_move_mm,
        r.on_contours_mm / voxel, fit_seconds, seconds);
    std::fflush(stdout);
}

/// The share of an object that lies in one of two masks alone.
double change(const Mask& before, const Mask& after) {
    std::int64_t inside = 0, changed = 0;
    for (std::size_t n = 0; n < before.values.size(); ++n) {
        inside += before.values[n] != 0;
        changed += (before.values[n] != 0) != (after.values[n] != 0);
    }
    return static_cast<double>(changed) / static_cast<double>(std::max<std::int64_t>(inside, 1));
}

/// How steady results are: what they change by, without and with the image, where the middle one of the contours is moved in
/// its plane.
void measure_move(const Structure& structure, const WantedDrawing& wanted, double voxels) {
    const ContourSet contours = drawn(structure, wanted);
    ContourSet moved = contours;
    Contour& contour = moved.contours[moved.contours.size() / 2];
    for (Vec3& p : contour.points) p += voxels * smallest(structure.truth.grid.spacing_mm()) * contour.plane.u;
    const Trial first(structure, contours), second(structure, moved);
    const auto with_image = [](const Trial& trial) { return trial.mask_of(trial.with_image().fitted.function); };
    fmt::print("{},{},{:.6f},{:.6f}\n", structure.name, wanted.name(), change(first.mask_without(), second.mask_without()),
               change(with_image(first), with_image(second)));
    std::fflush(stdout);
}

/// An image that knows nothing of the structure: noise, or that of a file, its middle where the structure's is.
Image other_image(const Structure& structure, const std::string& file) {
    if (file == "noise") {
        Image image = structure.image;
        Random random(seed_of(structure.name + "noise"));
        std::vector<float> values(static_cast<std::size_t>(image.grid.voxel_count()));
        for (float& value : values) value = static_cast<float>(random.gaussian());
        image.samples = std::move(values);
        return image;
    }
    Image image = read_image(file);
    const auto middle = [](const Grid& grid) { return grid.center_mm(grid.size.i / 2, grid.size.j / 2, grid.size.k / 2); };
    image.grid.index_to_mm.translation += middle(structure.truth.grid) - middle(image.grid);
    return image;
}

int run(const std::vector<std::string>& words) {
    if (words.size() < 4)
        throw Error(
            ErrorKind::invalid_input,
            "usage: kontur_images NAME IMAGE LABELS LABEL [FRAME] or NAME phantom ORGAN SPACING_MM; kinds, counts of planes "
            "and hands from KONTUR_IMAGES, as axial,3,exact;...");
    Structure structure = read_structure(words);
    if (const char* shift = std::getenv("KONTUR_IMAGES_SHIFT_MM"))  // an image that lies beside the drawing
        structure.image.grid.index_to_mm.translation += std::stod(shift) * Vec3{1, 1, 0.5};
    if (const char* file = std::getenv("KONTUR_IMAGES_OTHER")) structure.image = other_image(structure, file);
    const char* move = std::getenv("KONTUR_IMAGES_MOVE_VOXELS");
    for (const WantedDrawing& wanted : wanted_drawings()) try {
            if (move) measure_move(structure, wanted, std::stod(move));
            else measure(structure, wanted);
        } catch (const Error& error) {
            fmt::print(stderr, "{} {}: {}\n", structure.name, wanted.name(), error.what());
        }
    return 0;
}

}  // namespace
}  // namespace kontur

int main(int count, char** words) {
    try {
        return kontur::run({words + 1, words + count});
    } catch (const std::exception& error) {
        fmt::print(stderr, "kontur_images: error: {}\n", error.what());
        return 1;
    }
}
