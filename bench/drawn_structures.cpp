// SPDX-License-Identifier: Apache-2.0
#include "drawn_structures.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "kontur/base/error.h"
#include "kontur/extract/trace.h"
#include "kontur/io/image.h"
#include "kontur/phantom/phantom.h"
#include "kontur/phantom/random.h"

namespace kontur {
namespace {

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

}  // namespace

ContourSet drawn(const Structure& structure, const WantedDrawing& wanted) {
    ContourSet contours = trace(structure.truth, planes(structure, wanted.kind, wanted.count),
                                {.min_area_mm2 = 2 * std::pow(structure.truth.grid.voxel_volume_mm3(), 2.0 / 3)}, kAlone);
    Random random(seed_of(structure.name + wanted.kind + std::to_string(wanted.count) + "hand"));
    if (wanted.by_hand) draw_by_hand(contours, smallest(structure.truth.grid.spacing_mm()), random);
    return contours;
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

std::vector<WantedDrawing> wanted_drawings() {
    const char* chosen = std::getenv("KONTUR_IMAGES");
    std::vector<WantedDrawing> wanted;
    for (const char* kind : {"axial", "ortho", "oblique"})
        for (const int count : {3, 4, 5, 7, 10})
            for (const bool by_hand : {false, true}) {
                const WantedDrawing one{kind, count, by_hand};
                if (!chosen || std::string(chosen).find(one.name()) != std::string::npos) wanted.push_back(one);
            }
    return wanted;
}

}  // namespace kontur
