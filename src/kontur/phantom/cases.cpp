// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/cases.h"

#include <algorithm>
#include <functional>

#include "kontur/base/error.h"
#include "kontur/phantom/drawing.h"
#include "kontur/phantom/frames.h"
#include "kontur/phantom/section_planes.h"
#include "kontur/phantom/self_intersecting.h"

namespace kontur {
namespace {

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
        std::string names;
        for (const std::string& each : phantom_case_names()) names += (names.empty() ? "" : ", ") + each;
        throw Error(ErrorKind::invalid_input, "there is no phantom case \"" + std::string(name) + "\"; there are " + names);
    }
    PhantomCase result = hand ? by_hand(recipe->make(), *recipe->hand, seed_of(name)) : recipe->make();
    result.name = name;
    return result;
}

}  // namespace kontur
