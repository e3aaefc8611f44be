// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/cases.h"

#include <algorithm>
#include <functional>

#include "kontur/base/error.h"
#include "kontur/phantom/drawing.h"
#include "kontur/phantom/frames.h"
#include "kontur/phantom/self_intersecting.h"

namespace kontur {
namespace {

/// Box of the body's inside, to about a hundredth of its size.
Box3 extent(const Body& body) {
    constexpr int kSteps = 100;
    Box3 box;
    const Vec3 low = body.bounds().min, step = body.bounds().size() / kSteps;
    for (int k = 0; k <= kSteps; ++k)
        for (int j = 0; j <= kSteps; ++j)
            for (int i = 0; i <= kSteps; ++i)
                if (const Vec3 p = low + Vec3{i * step.x, j * step.y, k * step.z}; body.value(p) > 0) box.extend(p);
    return box;
}

/// Planes across an axis of the box: the first and last leave `end_share` of its length outside, the others lie evenly
/// between.
std::vector<Plane> planes_across(const Box3& box, int axis, int count, double end_share) {
    std::vector<Plane> planes;
    Vec3 normal{};
    normal[axis] = 1;
    for (int i = 0; i < count; ++i) {
        Vec3 origin = box.center();
        origin[axis] = box.min[axis] + box.size()[axis] * std::lerp(end_share, 1 - end_share, i / (count - 1.0));
        planes.push_back(make_plane(origin, normal));
    }
    return planes;
}

std::vector<Plane> parallel_planes(const Box3& box, int count) { return planes_across(box, 2, count, 0.9 / (count + 0.8)); }

std::vector<Plane> orthogonal_planes(const Box3& box, int sagittal, int coronal, int axial) {
    constexpr double kEndShare = 0.14;
    std::vector<Plane> planes = planes_across(box, 0, sagittal, kEndShare);
    for (const auto& more : {planes_across(box, 1, coronal, kEndShare), planes_across(box, 2, axial, kEndShare)})
        planes.insert(planes.end(), more.begin(), more.end());
    return planes;
}

/// Planes in random directions through random points of the middle half of the box.
std::vector<Plane> oblique_planes(const Box3& box, int count, Random& random) {
    std::vector<Plane> planes;
    for (int i = 0; i < count; ++i) {
        const Vec3 normal{random.gaussian(), random.gaussian(), random.gaussian()};
        const Vec3 share{random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25)};
        const Vec3 size = box.size();
        planes.push_back(make_plane(box.center() + Vec3{share.x * size.x, share.y * size.y, share.z * size.z}, normal));
    }
    return planes;
}

/// Planes through the box's vertical middle axis at equal angles.
std::vector<Plane> radial_planes(const Box3& box, int count) {
    std::vector<Plane> planes;
    for (int i = 0; i < count; ++i) {
        const double angle = std::numbers::pi * (i + 0.5) / count;
        planes.push_back(make_plane(box.center(), {std::cos(angle), std::sin(angle), 0}));
    }
    return planes;
}

std::vector<std::vector<Vec3>> surface_normals(const Body& body, const ContourSet& set) {
    std::vector<std::vector<Vec3>> normals;
    for (const Contour& contour : set.contours) {
        auto& of_contour = normals.emplace_back();
        for (const Vec3& p : contour.points) of_contour.push_back(body.outward_normal(p));
    }
    return normals;
}

PhantomCase section_case(const Body& body, const std::vector<Plane>& planes, std::size_t points, const Grid& grid,
                         const std::string& note) {
    PhantomCase result;
    result.note = note;
    result.body = body;
    result.contours = draw_sections(body, planes, points);
    result.grid = grid;
    result.normals = surface_normals(body, result.contours);
    return result;
}

PhantomCase liver_orthogonal14() {
    return section_case(
        liver(), orthogonal_planes(extent(liver()), 4, 5, 5), 6896, liver_grid(),
        "4 sagittal, 5 coronal and 5 axial contours of the liver, as many points and voxels as in Heckel et al. 2010");
}

PhantomCase metastasis_parallel17() {
    return section_case(metastasis(), parallel_planes(extent(metastasis()), 17), 3121, metastasis_grid(),
                        "17 axial contours of the metastasis, as many points and voxels as in Heckel et al. 2010");
}

PhantomCase metastasis_parallel7() {
    const PhantomCase all = metastasis_parallel17();
    PhantomCase result = all;
    result.note = "7 of the 17 axial contours of the metastasis";
    result.contours.contours.clear();
    result.normals.clear();
    for (const std::size_t c : {0, 3, 5, 8, 11, 13, 16}) {
        result.contours.contours.push_back(all.contours.contours[c]);
        result.normals.push_back(all.normals[c]);
    }
    return result;
}

PhantomCase liver_parallel14() {
    return section_case(liver(), parallel_planes(extent(liver()), 14), 5600, liver_grid(), "14 axial contours of the liver");
}

PhantomCase liver_oblique10() {
    Random random(seed_of("liver_oblique10"));
    const Box3 box = extent(liver());
    return section_case(liver(), oblique_planes(box, 10, random), 4000, oblique(grid_around(box, {1.5, 1.5, 2}, 12)),
                        "contours of the liver in 10 planes of random direction, on an oblique grid");
}

PhantomCase kidney_radial6() {
    const Box3 box = extent(kidney());
    return section_case(kidney(), radial_planes(box, 6), 1500, grid_around(box, {0.8, 0.8, 1}, 8),
                        "6 contours of the right kidney in planes through one vertical axis");
}

PhantomCase vertebra_parallel11() {
    const Box3 box = extent(vertebra());
    return section_case(vertebra(), parallel_planes(box, 11), 2600, grid_around(box, {0.6, 0.6, 0.8}, 6),
                        "axial contours of a vertebra in 11 planes: several per plane, the spinal canal as a hole in some");
}

PhantomCase self_intersecting() {
    SelfIntersectingCurves curves = self_intersecting_curves();
    PhantomCase result;
    result.note = "figures of eight and loops within loops, each in 5 parallel planes";
    result.contours = std::move(curves.contours);
    result.normals = std::move(curves.normals);
    result.grid = grid_around(bounding_box(result.contours), {1, 1, 1}, 12);
    return result;
}

PhantomCase by_hand(PhantomCase original, const HandOptions& options, std::uint64_t seed) {
    Random random(seed);
    original.contours = drawn_by_hand(std::move(original.contours), *original.body, options, random);
    original.normals = surface_normals(*original.body, original.contours);
    original.note += ", drawn by an unsteady hand";
    return original;
}

Body scaled(const Body& body, double factor) {
    return {body.name(), Box3{factor * body.bounds().min, factor * body.bounds().max},
            [body, factor](const Vec3& p) { return factor * body.value(p / factor); }};
}

ContourSet scaled(ContourSet set, double factor) {
    for (Contour& contour : set.contours) {
        contour.plane.origin *= factor;
        for (Vec3& p : contour.points) p *= factor;
    }
    return set;
}

struct Recipe {
    std::string_view name;
    std::function<PhantomCase()> make;
    std::optional<HandOptions> hand = {};  ///< how its "_hand" variant is drawn, if it has one
};

const std::vector<Recipe>& recipes() {
    static const HandOptions coarse{};
    static const HandOptions fine{.rms_mm = 0.24, .shortest_wave_mm = 10, .jitter_mm = 0.048};
    static const std::vector<Recipe> all{
        {"liver_orthogonal14", liver_orthogonal14, coarse},   {"metastasis_parallel17", metastasis_parallel17, fine},
        {"metastasis_parallel7", metastasis_parallel7, fine}, {"liver_parallel14", liver_parallel14, coarse},
        {"liver_oblique10", liver_oblique10, coarse},         {"kidney_radial6", kidney_radial6, coarse},
        {"vertebra_parallel11", vertebra_parallel11, fine},   {"self_intersecting", self_intersecting},
    };
    return all;
}

constexpr std::string_view kHandSuffix = "_hand";

}  // namespace

PhantomCase dense_liver_case(const DenseLiver& options) {
    if (options.points < 100)
        throw Error(ErrorKind::invalid_input, "a liver drawn with " + std::to_string(options.points) +
                                                  " points is too coarse; at least 100 are needed");
    constexpr double kMostUnscaled = 25000;
    const double points = static_cast<double>(options.points);
    const double scale = std::max(1.0, std::cbrt(points / kMostUnscaled));
    const int count = std::max(6, static_cast<int>(0.57 * std::sqrt(points)));
    const Box3 box = extent(liver());
    const std::vector<Plane> planes =
        options.orthogonal ? orthogonal_planes(box, count / 3, count / 3, count / 3) : parallel_planes(box, count);
    PhantomCase result;
    result.name = "dense_liver";
    result.note = "a liver cut by many planes";
    result.body = scaled(liver(), scale);
    // Drawn at its natural size, because the time to draw a section grows with its area.
    result.contours = scaled(draw_sections(liver(), planes, options.points), scale);
    if (options.by_hand) {
        Random random(seed_of(result.name));
        result.contours = drawn_by_hand(std::move(result.contours), *result.body, {}, random);
    }
    result.grid = grid_around(bounding_box(result.contours), Vec3{scale, scale, scale}, 12);
    result.normals = surface_normals(*result.body, result.contours);
    return result;
}

std::vector<std::string> phantom_case_names() {
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes()) {
        names.emplace_back(recipe.name);
        if (recipe.hand) names.push_back(std::string(recipe.name) + std::string(kHandSuffix));
    }
    return names;
}

PhantomCase phantom_case(std::string_view name) {
    const bool hand = name.ends_with(kHandSuffix);
    const std::string_view stem = hand ? name.substr(0, name.size() - kHandSuffix.size()) : name;
    const auto recipe = std::ranges::find(recipes(), stem, &Recipe::name);
    if (recipe == recipes().end() || (hand && !recipe->hand)) {
        std::string known;
        for (const std::string& each : phantom_case_names()) known += (known.empty() ? "" : ", ") + each;
        throw Error(ErrorKind::invalid_input, "there is no phantom case \"" + std::string(name) + "\"; there are " + known);
    }
    PhantomCase result = hand ? by_hand(recipe->make(), *recipe->hand, seed_of(name)) : recipe->make();
    result.name = name;
    return result;
}

}  // namespace kontur
