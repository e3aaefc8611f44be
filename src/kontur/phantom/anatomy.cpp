// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/anatomy.h"

#include "kontur/phantom/bodies.h"
#include "kontur/phantom/depth.h"
#include "kontur/phantom/random.h"

namespace kontur {
namespace {

constexpr double kFar_mm = 400;
constexpr double kVertebraPitch_mm = 36;
constexpr Vec3 kVertebra{0, 55, -10};  // centre of the vertebra that is a body of its own

const Box3 kEverywhere{{-kFar_mm, -kFar_mm, -kFar_mm}, {kFar_mm, kFar_mm, kFar_mm}};

Box3 column_box(const Vec3& center, double radius_x, double radius_y) {
    return {center - Vec3{radius_x, radius_y, kFar_mm}, center + Vec3{radius_x, radius_y, kFar_mm}};
}

Tissue column(const Vec3& center, double radius_x, double radius_y, std::vector<Layer> layers) {
    return {column_box(center, radius_x, radius_y),
            [=](const Vec3& p) { return depth::elliptic_cylinder(p - center, radius_x, radius_y); }, std::move(layers)};
}

Tissue ellipsoid(const Vec3& center, const Vec3& radii, std::vector<Layer> layers) {
    return {{center - radii, center + radii},
            [=](const Vec3& p) { return depth::ellipsoid(p - center, radii); },
            std::move(layers)};
}

Tissue tube(const Vec3& a, const Vec3& b, double radius, std::vector<Layer> layers) {
    Box3 box;
    box.extend(a);
    box.extend(b);
    return {box.padded(radius), [=](const Vec3& p) { return depth::capsule(p, a, b, radius); }, std::move(layers)};
}

Tissue exact(const Body& body, std::vector<Layer> layers) {
    return {body.bounds(), [body](const Vec3& p) { return body.value(p); }, std::move(layers)};
}

/// Depth below the inner surface of the abdominal wall.
double cavity(const Vec3& p) { return depth::elliptic_cylinder(p - Vec3{0, -4, 0}, 163, 97); }

Tissue in_cavity(Tissue tissue, double margin_mm) {
    tissue.depth = [inner = std::move(tissue.depth), margin_mm](const Vec3& p) {
        return std::min(inner(p), cavity(p) - margin_mm);
    };
    return tissue;
}

/// The gas in a hollow organ of a patient lying on the back: what of its content lies in front of a level.
Tissue gas_in(Tissue organ, double wall_mm, double level_y) {
    organ.depth = [inner = std::move(organ.depth), wall_mm, level_y](const Vec3& p) {
        return std::min(inner(p) - wall_mm, level_y - p.y);
    };
    organ.layers = {{0, -930}};
    return organ;
}

/// Ribs run around the wall, descend towards the front and end before the midline.
double ribs(const Vec3& p) {
    constexpr double kPitch_mm = 29, kDescent = 0.5, kHalfThickness_mm = 3.6, kHalfHeight_mm = 6.5;
    const double radial = depth::elliptic_cylinder(p - Vec3{0, -3, 0}, 169, 102);
    const double along = p.z - kDescent * p.y;
    const double vertical = along - kPitch_mm * std::round(along / kPitch_mm);
    const double section = kHalfThickness_mm * (1 - std::hypot(radial / kHalfThickness_mm, vertical / kHalfHeight_mm));
    const double costal_margin = along + 70 - 0.3 * std::abs(p.x);
    return std::min({section, std::abs(p.x) - (p.y < 0 ? 85 : 30), costal_margin});
}

/// The lungs' bases above the two domes of the diaphragm.
double lungs(const Vec3& p) {
    const Vec3 dome = p.x < 0 ? Vec3{-90, -14, 100} : Vec3{88, 0, 92};
    const double back = p.y - dome.y;
    const double u = (p.x - dome.x) / 80, v = back / (back > 0 ? 86 : 200);  // the recess is deep behind, shallow in front
    const double below = 0.6 * (p.z - dome.z + 56 * (u * u + v * v));
    const double mediastinum = depth::elliptic_cylinder(p - Vec3{0, -10, 0}, 46, 125);
    return depth::subtract(depth::intersect(cavity(p) - 3, below, 8), mediastinum, 10);
}

Vec3 in_nearest_vertebra(Vec3 p) {
    p.z -= kVertebraPitch_mm * std::round((p.z - kVertebra.z) / kVertebraPitch_mm);
    return p;
}

void add_wall(std::vector<Tissue>& tissues) {
    const auto skin = [](const Vec3& p) {
        const double trunk = depth::elliptic_cylinder(p - Vec3{0, -4, 0}, 190, 124);
        return depth::subtract(trunk, depth::elliptic_cylinder(p - Vec3{0, 134, 0}, 22, 17), 14);  // the groove of the back
    };
    tissues.push_back({kEverywhere, skin, {{0, 5}, {2, -105}}});
    tissues.push_back(column({0, -2, 0}, 176, 108, {{0, 55}, {4.5, -60}, {5.5, 58}}));
    tissues.push_back({column_box({0, -4, 0}, 163, 97), cavity, {{0, -98}}});
    tissues.push_back({kEverywhere, ribs, {{0, 600}, {1.6, 230}}});
    tissues.push_back({kEverywhere, lungs, {{0, -860}}});
    tissues.push_back(in_cavity(ellipsoid({24, -40, 112}, {66, 46, 40}, {{0, 60}, {5, 135}}), 6));  // heart
}

void add_spine(std::vector<Tissue>& tissues) {
    for (const double side : {-1.0, 1.0}) {
        tissues.push_back(column({33 * side, 90, 0}, 29, 17, {{0, 55}}));             // erector spinae
        tissues.push_back(ellipsoid({38 * side, 60, -95}, {17, 19, 92}, {{0, 58}}));  // psoas
        tissues.push_back(ellipsoid({17 * side, 36, 40}, {6, 13, 85}, {{0, 56}}));    // crura of the diaphragm
    }
    tissues.push_back(column(kVertebra, 23, 16.5, {{0, 85}}));                              // discs
    tissues.push_back(column(kVertebra + Vec3{0, 25, 0}, 11.5, 8.5, {{0, -20}, {1, 14}}));  // spinal canal
    tissues.push_back(column(kVertebra + Vec3{0, 25, 0}, 6, 4.5, {{0, 40}}));               // cord
    const Body bone = vertebra();
    Box3 box = bone.bounds();
    box.min.z = -kFar_mm;
    box.max.z = kFar_mm;
    tissues.push_back({box, [bone](const Vec3& p) { return bone.value(in_nearest_vertebra(p)); }, {{0, 620}, {1.7, 210}}});
}

void add_bowel(std::vector<Tissue>& tissues) {
    Random random(seed_of("bowel"));
    for (int loop = 0; loop < 90; ++loop) {
        const Vec3 center{random.uniform(-72, 122), random.uniform(-80, 18), random.uniform(-190, -38)};
        const Vec3 radii{random.uniform(11, 21), random.uniform(10, 16), random.uniform(10, 18)};
        tissues.push_back(in_cavity(ellipsoid(center, radii, {{0, 85}, {2.2, 22}}), 4));
    }
    const std::vector<Layer> stool{{0, 60}, {2.5, -15}};
    for (const Tissue& colon :
         {tube({-125, 5, -160}, {-118, -10, -92}, 24, stool), tube({-100, -68, -104}, {10, -80, -112}, 19, stool),
          tube({10, -80, -112}, {112, -52, -58}, 19, stool), tube({124, -22, -40}, {128, 36, -150}, 20, stool)}) {
        tissues.push_back(in_cavity(colon, 3));
        tissues.push_back(gas_in(in_cavity(colon, 3), 2.5, colon.bounds.center().y - 6));
    }
}

void add_organs(std::vector<Tissue>& tissues) {
    const Tissue stomach = in_cavity(ellipsoid({78, -38, 32}, {56, 44, 48}, {{0, 80}, {3.5, 18}}), 4);
    tissues.push_back(stomach);
    tissues.push_back(gas_in(stomach, 3.5, -52));
    tissues.push_back(in_cavity({{{70, -30, -50}, {163, 93, 90}},
                                 [](const Vec3& p) {
                                     const double outer = depth::ellipsoid(p - Vec3{122, 34, 22}, {40, 52, 56});
                                     return depth::subtract(outer, depth::ellipsoid(p - Vec3{84, 8, 22}, {36, 44, 60}), 8);
                                 },
                                 {{0, 122}}},
                                4));                                                   // spleen
    tissues.push_back(tube({-28, -8, -32}, {22, -16, -12}, 12, {{0, 98}}));            // pancreas, head to body
    tissues.push_back(tube({22, -16, -12}, {92, 22, 8}, 9.5, {{0, 98}}));              // pancreas, tail
    tissues.push_back(column({15, 26, 0}, 10.5, 10.5, {{0, 90}, {1.2, 165}}));         // aorta
    tissues.push_back(column({-21, 24, 0}, 13, 10, {{0, 150}}));                       // inferior vena cava
    tissues.push_back(tube({15, 16, -28}, {20, -14, -70}, 4, {{0, 165}}));             // superior mesenteric artery
    tissues.push_back(tube({2, -22, -80}, {-22, -8, -18}, 6, {{0, 170}}));             // superior mesenteric vein
    tissues.push_back(ellipsoid({-42, -64, -40}, {14, 18, 28}, {{0, 50}, {1.2, 8}}));  // gallbladder
    const Body right_kidney = kidney();
    const Box3 box = right_kidney.bounds();
    tissues.push_back({{{-box.max.x, box.min.y, box.min.z + 12}, {-box.min.x, box.max.y, box.max.z + 12}},
                       [right_kidney](const Vec3& p) {
                           return right_kidney.value({-p.x, p.y, p.z - 12});
                       },
                       {{0, 185}, {7, 150}}});  // left kidney
}

/// Portal and hepatic veins, cut off where they leave the liver.
void add_liver(std::vector<Tissue>& tissues) {
    const Body parenchyma = liver();
    tissues.push_back(exact(parenchyma, {{0, 110}}));
    struct Vessel {
        Vec3 from, to;
        double radius;
    };
    const Vec3 porta{-42, 4, -8}, right_branch{-82, -4, -2}, cava{-28, 20, 62};
    for (const auto& [from, to, radius] :
         {Vessel{{-22, -6, -22}, porta, 6.5}, Vessel{porta, right_branch, 5.5}, Vessel{right_branch, {-112, 24, -24}, 3.5},
          Vessel{right_branch, {-100, -44, -30}, 3.4}, Vessel{right_branch, {-92, -52, 26}, 3.2},
          Vessel{{-112, 24, -24}, {-138, 30, -42}, 2.3}, Vessel{porta, {-24, -34, 16}, 4.2},
          Vessel{{-24, -34, 16}, {12, -40, 34}, 3}, Vessel{cava, {-88, 12, 44}, 5},
          Vessel{{-88, 12, 44}, {-136, -6, 22}, 3.2}, Vessel{cava, {-62, -32, 40}, 4.6},
          Vessel{{-62, -32, 40}, {-80, -68, 14}, 2.8}, Vessel{cava, {-10, -26, 42}, 4.2}}) {
        Tissue vessel = tube(from, to, radius, {{0, 165}});
        vessel.depth = [lumen = std::move(vessel.depth), parenchyma](const Vec3& p) {
            return std::min(lumen(p), parenchyma.value(p));
        };
        tissues.push_back(std::move(vessel));
    }
    tissues.push_back(exact(metastasis(), {{0, 84}, {3, 68}}));
}

}  // namespace

std::vector<Tissue> abdominal_tissues() {
    std::vector<Tissue> tissues;
    add_wall(tissues);
    add_spine(tissues);
    add_bowel(tissues);
    add_organs(tissues);
    add_liver(tissues);
    tissues.push_back(exact(kidney(), {{0, 185}, {7, 150}}));
    return tissues;
}

}  // namespace kontur
