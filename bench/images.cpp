// SPDX-License-Identifier: Apache-2.0
// What the image between the contours is worth: structures cut by few planes, segmented without and with their image. One
// line of CSV for each drawing. bench/images.py calls it for every structure and makes the tables.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/extract/find_surface.h"
#include "kontur/extract/trace.h"
#include "kontur/extract/voxelize.h"
#include "kontur/image/follow_image.h"
#include "kontur/io/image.h"
#include "kontur/measure/compare.h"
#include "kontur/phantom/phantom.h"
#include "kontur/phantom/random.h"
#include "kontur/pipeline.h"

namespace kontur {
namespace {

const Work kAlone{.threads = 1};

/// Of the process: others on the machine do not matter.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Structure {
    std::string name;
    Image image;
    Mask truth;
};

/// The part of the grid around the object, with a quarter of its extent to spare where the grid has it.
Mask cropped(const Mask& mask) {
    const Index3& n = mask.grid.size;
    Index3 low = n, high{-1, -1, -1};
    for (std::int64_t k = 0; k < n.k; ++k)
        for (std::int64_t j = 0; j < n.j; ++j)
            for (std::int64_t i = 0; i < n.i; ++i)
                if (mask.values[mask.grid.offset(i, j, k)])
                    for (int axis = 0; axis < 3; ++axis) {
                        const std::int64_t at = axis == 0 ? i : axis == 1 ? j : k;
                        low[axis] = std::min(low[axis], at);
                        high[axis] = std::max(high[axis], at);
                    }
    Mask part;
    part.grid = mask.grid;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t margin = (high[axis] - low[axis]) / 4 + 4;
        low[axis] = std::max<std::int64_t>(low[axis] - margin, 0);
        part.grid.size[axis] = std::min(high[axis] + margin, n[axis] - 1) - low[axis] + 1;
    }
    part.grid.index_to_mm.translation = mask.grid.center_mm(low.i, low.j, low.k);
    part.values.resize(static_cast<std::size_t>(part.grid.voxel_count()));
    for (std::int64_t k = 0; k < part.grid.size.k; ++k)
        for (std::int64_t j = 0; j < part.grid.size.j; ++j)
            for (std::int64_t i = 0; i < part.grid.size.i; ++i)
                part.values[part.grid.offset(i, j, k)] = mask.values[mask.grid.offset(i + low.i, j + low.j, k + low.k)];
    return part;
}

std::vector<Vec3> inside(const Mask& mask) {
    std::vector<Vec3> indices;
    const Index3& n = mask.grid.size;
    for (std::int64_t k = 0; k < n.k; ++k)
        for (std::int64_t j = 0; j < n.j; ++j)
            for (std::int64_t i = 0; i < n.i; ++i)
                if (mask.values[mask.grid.offset(i, j, k)])
                    indices.push_back({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
    return indices;
}

/// `count` planes across an axis of the grid, each in the middle of its share of the object, at voxel centres.
void add_stack(const Mask& truth, const Box3& box, int axis, int count, std::vector<Plane>& planes) {
    const Affine3& to_mm = truth.grid.index_to_mm;
    const Vec3 normal = normalized(cross(to_mm.column((axis + 1) % 3), to_mm.column((axis + 2) % 3)));
    for (int n = 0; n < count; ++n) {
        Vec3 at = box.center();
        at[axis] = std::round(box.min[axis] - 0.5 + (box.size()[axis] + 1) * (n + 0.5) / count);
        planes.push_back(make_plane(to_mm.apply(at), normal));
    }
}

std::vector<Plane> planes(const Structure& structure, const std::string& kind, int count) {
    const Mask& truth = structure.truth;
    const std::vector<Vec3> voxels = inside(truth);
    const Box3 box = bounding_box(voxels);
    const Vec3 spacing = truth.grid.spacing_mm();
    std::vector<Plane> result;
    if (kind == "axial") {
        const int thick = spacing.x > 1.2 * std::min(spacing.y, spacing.z)   ? 0
                          : spacing.y > 1.2 * std::min(spacing.x, spacing.z) ? 1
                                                                             : 2;
        add_stack(truth, box, thick, count, result);
    } else if (kind == "ortho") {
        for (int n = 0; n < 3; ++n) add_stack(truth, box, 2 - n, count / 3 + (count % 3 > n ? 1 : 0), result);
    } else {
        Random random(seed_of(structure.name + kind + std::to_string(count)));
        for (int n = 0; n < count; ++n) {
            const Vec3 normal = normalized({random.gaussian(), random.gaussian(), random.gaussian()});
            std::vector<double> heights;
            for (const Vec3& v : voxels) heights.push_back(dot(normal, truth.grid.index_to_mm.apply(v)));
            std::sort(heights.begin(), heights.end());
            const auto at = [&](double f) {
                return heights[static_cast<std::size_t>(f * static_cast<double>(heights.size() - 1))];
            };
            const double height = random.uniform(at(0.15), at(0.85));
            const Vec3 middle = truth.grid.index_to_mm.apply(box.center());
            result.push_back(make_plane(middle + (height - dot(normal, middle)) * normal, normal));
        }
    }
    return result;
}

/// Smooth noise of 0.7 voxels rms along each contour's normal, waves longer than 12 voxels.
void draw_by_hand(ContourSet& set, double voxel_mm, Random& random) {
    for (Contour& contour : set.contours) {
        const std::vector<Vec3> p = contour.points;
        const std::size_t n = p.size();
        std::vector<double> along{0};
        for (std::size_t i = 0; i < n; ++i) along.push_back(along.back() + distance(p[i], p[(i + 1) % n]));
        const int waves = std::max(1, static_cast<int>(along.back() / (12 * voxel_mm)));
        std::vector<double> noise(n);
        for (int k = 0; k <= waves; ++k) {
            const double a = random.gaussian(), b = random.gaussian();
            for (std::size_t i = 0; i < n; ++i) {
                const double phase = 2 * std::numbers::pi * k * along[i] / along.back();
                noise[i] += a * std::cos(phase) + b * std::sin(phase);
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 normal = normalized(cross(p[(i + 1) % n] - p[(i + n - 1) % n], contour.plane.normal));
            contour.points[i] += 0.7 * voxel_mm / std::sqrt(waves + 1.0) * noise[i] * normal;
        }
    }
}

std::string scores(const Mask& mask, const Mask& truth) {
    const Comparison c = compare(mask, truth, {1});
    if (!c.surface) return fmt::format("{:.4f},,", c.dice);
    return fmt::format("{:.4f},{:.3f},{:.4f}", c.dice, c.surface->hausdorff95_mm, c.surface->mean_surface_distance_mm);
}

/// Planes of a kind, and how the contours in them are drawn.
struct DrawnPlanes {
    std::string kind;
    int count;
    bool by_hand;

    std::string name() const { return fmt::format("{},{},{}", kind, count, by_hand ? "hand" : "exact"); }
};

ContourSet drawn(const Structure& structure, const DrawnPlanes& wanted) {
    ContourSet contours = trace(structure.truth, planes(structure, wanted.kind, wanted.count),
                                {.min_area_mm2 = 2 * std::pow(structure.truth.grid.voxel_volume_mm3(), 2.0 / 3)}, kAlone);
    Random random(seed_of(structure.name + wanted.kind + std::to_string(wanted.count) + "hand"));
    if (wanted.by_hand) draw_by_hand(contours, smallest(structure.truth.grid.spacing_mm()), random);
    return contours;
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

void measure(const Structure& structure, const DrawnPlanes& wanted) {
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
void measure_move(const Structure& structure, const DrawnPlanes& wanted, double voxels) {
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

Structure read_structure(const std::vector<std::string>& words) {
    Structure structure{words[0], {}, {}};
    if (words[1] == "phantom") {
        const std::vector<Body> bodies = phantom_bodies();
        const auto body = std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.name() == words[2]; });
        if (body == bodies.end()) throw Error(ErrorKind::invalid_input, "the phantom has no " + words[2]);
        const double spacing = std::stod(words[3]);
        structure.truth = make_truth_mask(*body, grid_around(body->bounds(), {spacing, spacing, spacing}, 10 * spacing));
        structure.image = make_phantom_image(structure.truth.grid);
        return structure;
    }
    ReadImageOptions read;
    if (words.size() > 4) read.frame = std::stoll(words[4]);
    structure.image = read_image(words[1], read);
    structure.truth = cropped(read_mask(words[2], words[3].empty() ? std::nullopt : std::optional(std::stoll(words[3]))));
    return structure;
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
    const char *chosen = std::getenv("KONTUR_IMAGES"), *move = std::getenv("KONTUR_IMAGES_MOVE_VOXELS");
    for (const char* kind : {"axial", "ortho", "oblique"})
        for (const int count : {3, 4, 5, 7, 10})
            for (const bool by_hand : {false, true}) {
                const DrawnPlanes wanted{kind, count, by_hand};
                if (chosen && std::string(chosen).find(wanted.name()) == std::string::npos) continue;
                try {
                    if (move) measure_move(structure, wanted, std::stod(move));
                    else measure(structure, wanted);
                } catch (const Error& error) {
                    fmt::print(stderr, "{} {}: {}\n", structure.name, wanted.name(), error.what());
                }
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
