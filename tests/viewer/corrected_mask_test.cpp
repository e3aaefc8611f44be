// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/corrected_mask.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "kontur/correct/existing_mesh.h"
#include "kontur/correct/mask_change.h"
#include "kontur/extract/mesh_mask.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/image.h"
#include "support/expect_error.h"
#include "support/random.h"
#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"
#include "viewer/session/session.h"

namespace kontur::viewer {
namespace {

using kontur::test::TemporaryFolder;
using nlohmann::json;

Grid sheared_grid() {
    Grid grid{{34, 31, 22}, {}};
    grid.index_to_mm.linear = {{{1.1, 0.05, 0}, {0, 1.2, 0.6}, {0.02, 0, 1.9}}};
    grid.index_to_mm.translation = {2.5, -3, 1};
    return grid;
}

Mask ball(const Grid& grid, const Vec3& center, double radius) {
    Mask mask{grid, {}};
    for (std::int64_t n = 0; n < grid.voxel_count(); ++n) {
        const Index3 v = index_at(static_cast<std::size_t>(n), grid.size);
        mask.values.push_back(distance(grid.center_mm(v.i, v.j, v.k), center) < radius);
    }
    return mask;
}

TEST(StoredMask, IsTheMaskByteForByteAndNamedByIt) {
    std::mt19937 random = kontur::test::random_of_this_test();
    Mask mask{sheared_grid(), {}};
    for (std::int64_t n = 0; n < mask.grid.voxel_count(); ++n)
        mask.values.push_back(n > 4000 && n < 9000 && random() % 3 == 0);
    const StoredMask stored(mask), again(stored.header(), stored.packed());
    EXPECT_EQ(again.mask().values, mask.values);
    EXPECT_EQ(again.grid(), mask.grid);
    EXPECT_EQ(again.hash(), stored.hash());
    EXPECT_LT(stored.packed().size(), mask.values.size() / 8);
    mask.values[4321] ^= 1;
    EXPECT_NE(StoredMask(mask).hash(), stored.hash());
    std::fill(mask.values.begin(), mask.values.end(), 0);
    EXPECT_KONTUR_ERROR(StoredMask(mask), ErrorKind::invalid_input, "nothing to correct");
}

TEST(StoredMask, RefusesAGridThatNoMachineShouldFill) {
    const StoredMask stored(ball({{40, 40, 40}, {}}, {20, 20, 20}, 9));
    std::string header = stored.header();
    const std::string size = "[40,40,40]";
    ASSERT_NE(header.find(size), std::string::npos) << header;
    header.replace(header.find(size), size.size(), "[2048,2048,513]");
    EXPECT_KONTUR_ERROR(StoredMask(header, stored.packed()), ErrorKind::invalid_input,
                        "has 2048 x 2048 x 513 voxels; at most 2147483648 are possible");
}

TEST(CorrectedMask, HasTheSameVoxelsOnAGridThatIsAPartOfItsOwn) {
    const Mask mask = ball(sheared_grid(), {22, 20, 20}, 9);
    const IndexBox box{{5, 4, 2}, {30, 29, 20}};
    const Mask part = on_grid(mask, grid_of(mask.grid, box));
    for (std::int64_t k = 0; k < part.grid.size.k; ++k)
        for (std::int64_t j = 0; j < part.grid.size.j; ++j)
            for (std::int64_t i = 0; i < part.grid.size.i; ++i)
                ASSERT_EQ(part.values[part.grid.offset(i, j, k)], mask.values[mask.grid.offset(i + 5, j + 4, k + 2)]);
    Grid flipped = mask.grid;
    flipped.index_to_mm.translation = mask.grid.center_mm(33, 0, 0);
    flipped.index_to_mm.set_column(0, -mask.grid.index_to_mm.column(0));
    EXPECT_EQ(on_grid(on_grid(mask, flipped), mask.grid).values, mask.values);
}

TEST(CorrectedMask, OnAFinerGridItIsAsLargeAndSmooth) {
    const Grid fine{{80, 80, 80}, {{{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}}, {2, 2, 0}}};
    const Mask mask = ball(sheared_grid(), {22, 20, 20}, 9), there = on_grid(mask, fine);
    const auto ml = [](const Mask& one) {
        return static_cast<double>(std::ranges::count(one.values, 1)) * one.grid.voxel_volume_mm3() / 1000;
    };
    EXPECT_NEAR(ml(there), ml(mask), 0.08 * ml(mask));
    EXPECT_GT(std::ranges::count(there.values, 1), 0);
}

TEST(CorrectedMask, ItsSurfaceIsASolidAndKnowsWhoMadeIt) {
    const Mask mask = ball(sheared_grid(), {22, 20, 20}, 9);
    Corrections corrections;
    const Plane plane{{22, 20, 20}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    Contour circle{plane, {}};
    for (int n = 0; n < 60; ++n) circle.points.push_back(plane.from_uv(7 * std::cos(0.1047 * n), 7 * std::sin(0.1047 * n)));
    corrections.drawing.contours = {circle};
    const CorrectedMask corrected = correct(mask, corrections);
    const TriangleMesh mesh = mesh_of(corrected.mask);
    const MeshTopology solid = topology(mesh);
    EXPECT_TRUE(solid.closed && solid.oriented);
    EXPECT_EQ(solid.euler, 2);
    EXPECT_NEAR(signed_volume_mm3(mesh) / 1000, corrected.report.volume_ml, 0.1 * corrected.report.volume_ml);
    const ExistingSurface surface(mask);
    const MaskChange change = mask_change({mask, surface}, corrections, {});
    const CorrectedMesh shown = ExistingMesh(surface).corrected(change.lattice.get(), change.voxels);
    const TriangleMesh& fast = shown.mesh;
    const std::vector<std::uint8_t> origins = origins_of(shown.made_by);
    ASSERT_EQ(origins.size(), fast.points.size());
    double farthest_mm = 0;
    for (std::size_t n = 0; n < origins.size(); ++n)
        if (origins[n] != 0) farthest_mm = std::max(farthest_mm, std::abs(fast.points[n].z - 20));
    EXPECT_GT(farthest_mm, 2) << "carried on";
    EXPECT_LT(farthest_mm, corrected.report.reach_mm + 2);
    EXPECT_EQ(topology(fast).euler, 2);
    EXPECT_TRUE(topology(fast).closed && topology(fast).oriented);
    EXPECT_EQ(voxelize_mesh(fast, mask.grid).mask.values, corrected.mask.values) << "each voxel on its side";
    EXPECT_NEAR(signed_volume_mm3(fast) / 1000, corrected.report.volume_ml, 0.03 * corrected.report.volume_ml);
    Mask none = mask;
    std::fill(none.values.begin(), none.values.end(), 0);
    EXPECT_TRUE(mesh_of(none).triangles.empty());
}

/// A session with a mask that its contours correct.
struct SessionWithMask {
    Mask mask = ball({{40, 40, 40}, {}}, {20, 20, 20}, 9);
    TemporaryFolder folder;
    Session session{{test::flat_image(), "flat", {"/images/flat.nii", "40x40x40-int16-0"}, {}}, folder.path() / "a.kontur"};
    Id id = add();

    Id add() {
        ContourSet set;
        set.name = "Liver";
        return session.add_structures("Import a mask", {set}, {{0, {std::make_shared<const StoredMask>(mask), "Net 7"}}})
            .front();
    }
    json ask(json message) {
        message["seq"] = 1;
        return json::parse(session.call(message.dump()));
    }
    /// A closed circle, or an arc from one angle to another.
    json draw(double radius, double from = 0, double to = 6.28) {
        json control = json::array();
        const bool is_closed = to - from > 6;
        for (int n = 0; n < 40; ++n) {
            const double angle = from + (to - from) * n / (is_closed ? 40 : 39);
            control.push_back(
                {{"at", {20 + radius * std::cos(angle), 20 + radius * std::sin(angle), 20}}, {"kind", "line"}});
        }
        return ask({{"call", "contour.add"},
                    {"structure", id},
                    {"plane", {{"origin", {20, 20, 20}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}}},
                    {"control", control},
                    {"closed", is_closed}});
    }
    std::vector<std::uint8_t> exported(const std::string& name) {
        write_file_atomically(folder.path() / name, session.exported(name, id).bytes);
        return select_nonzero(read_image(folder.path() / name)).values;
    }
    /// What the library makes of what is drawn.
    CorrectedMask expected() {
        const State state = session.state();
        const StructureMask how = *state.structures.at(id).mask;
        return correct(mask, corrections_of(contour_set(state, id), how), correct_options(how));
    }
};

TEST(CorrectedMask, FilesHoldWhatTheLibraryMakesOfTheCorrections) {
    SessionWithMask here;
    EXPECT_EQ(here.exported("mask.nii.gz"), here.mask.values) << "nothing is corrected yet";
    ASSERT_TRUE(here.draw(11.5).contains("result"));
    EXPECT_EQ(here.exported("mask.nii.gz"), here.expected().mask.values);
    EXPECT_NE(here.exported("mask.nii.gz"), here.mask.values);
    EXPECT_EQ(here.exported("labels.nii.gz"), here.exported("mask.nii.gz"));
    here.ask({{"call", "undo"}});
    EXPECT_EQ(here.exported("mask.nii.gz"), here.mask.values) << "undo of all gives what came in";
}

TEST(CorrectedMask, AStrokeReplacesAPieceOfTheOutline) {
    SessionWithMask here;
    json control = json::array();
    for (int n = 0; n <= 20; ++n) {
        const double part = n / 20.0, angle = 0.2 + part, radius = 9 + 3 * std::sin(3.14159 * part);
        control.push_back({{"at", {20 + radius * std::cos(angle), 20 + radius * std::sin(angle), 20}}, {"kind", "line"}});
    }
    const json reply =
        here.ask({{"call", "contour.add"},
                  {"structure", here.id},
                  {"plane", {{"origin", {20, 20, 20}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}}},
                  {"control", control},
                  {"closed", false}});
    ASSERT_TRUE(reply.contains("result")) << reply;
    const CorrectedMask expected = here.expected();
    EXPECT_GT(expected.report.added_drawn, 0);
    EXPECT_EQ(here.exported("mask.nii.gz"), expected.mask.values);
}

TEST(CorrectedMask, ALineThatCorrectsNothingIsRefusedBeforeItIsAStep) {
    SessionWithMask here;
    const json error = here.draw(16, 0.2, 0.8)["error"];
    EXPECT_EQ(error["kind"], "invalid_input");
    EXPECT_EQ(error["message"].get<std::string>().rfind("The line is open, and an end of it lies ", 0), 0u) << error;
    EXPECT_TRUE(here.session.state().contours.empty());
    EXPECT_EQ(here.ask({{"call", "undo"}})["result"]["label"], "Import a mask");
}

TEST(CorrectedMask, PlanesAndPointsCorrectItToo) {
    SessionWithMask here;
    const json plane{{"origin", {20, 20, 27}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}};
    EXPECT_TRUE(here.ask({{"call", "structure.set"}, {"id", here.id}, {"empty_planes", {plane}}}).contains("result"));
    EXPECT_EQ(here.exported("mask.nii.gz"), here.expected().mask.values);
    EXPECT_GT(here.expected().report.removed_drawn, 0);
    const json confirmed{{"origin", {20, 20, 14}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}};
    EXPECT_TRUE(
        here.ask({{"call", "structure.set"}, {"id", here.id}, {"confirmed_planes", {confirmed}}}).contains("result"));
    EXPECT_EQ(here.ask({{"call", "undo"}})["result"]["label"], "Confirm a plane of Liver");
    const json point{{"call", "point.add"}, {"structure", here.id}, {"at", {20, 31, 20}}};
    EXPECT_TRUE(here.ask(point).contains("error")) << "its surface is the mask's";
    json inside = point;
    inside["kind"] = "interior";
    EXPECT_TRUE(here.ask(inside).contains("result"));
    EXPECT_EQ(here.exported("mask.nii.gz"), here.expected().mask.values);
    EXPECT_GT(here.expected().report.added_carried, 0);
    EXPECT_TRUE(
        here.ask({{"call", "structure.set"}, {"id", here.id}, {"reach", 0.5}, {"drop_loose", true}}).contains("result"));
    EXPECT_EQ(here.exported("mask.nii.gz"), here.expected().mask.values);
    EXPECT_TRUE(here.ask({{"call", "structure.set"}, {"id", here.id}, {"reach", 5}}).contains("error"));
}

TEST(CorrectedMask, APlaneIsEmptyOrRightOrDrawnIn) {
    SessionWithMask here;
    const json plane{{"origin", {20, 20, 20}}, {"u", {1, 0, 0}}, {"v", {0, 1, 0}}, {"normal", {0, 0, 1}}};
    const auto set = [&](const char* what) {
        return here.ask({{"call", "structure.set"}, {"id", here.id}, {what, {plane}}});
    };
    const auto structure = [&] { return here.session.state().structures.at(here.id); };
    ASSERT_TRUE(set("confirmed_planes").contains("result"));
    ASSERT_TRUE(set("empty_planes").contains("result"));
    EXPECT_TRUE(structure().mask->confirmed_planes.empty());
    ASSERT_TRUE(set("confirmed_planes").contains("result"));
    EXPECT_TRUE(structure().empty_planes.empty());
    ASSERT_TRUE(here.draw(10).contains("result"));
    EXPECT_TRUE(structure().mask->confirmed_planes.empty());
    EXPECT_EQ(set("empty_planes")["error"]["message"], "Liver is drawn in this plane; delete that correction first");
    here.ask({{"call", "undo"}});
    EXPECT_EQ(structure().mask->confirmed_planes.size(), 1u) << "one step";
}

TEST(CorrectedMask, PagesAreToldWhatTheCorrectionsComeTo) {
    SessionWithMask here;
    here.draw(11.5);
    here.session.wait_for_surfaces();
    const json greeting = json::parse(here.session.greeting());
    const json& surface = greeting["surfaces"].at(0);
    EXPECT_EQ(surface["stage"], "finished");
    const CorrectReport report = here.expected().report;
    EXPECT_EQ(surface["correction"]["text"], sentence(report));
    EXPECT_EQ(surface["correction"]["reach_mm"], report.reach_mm);
    EXPECT_EQ(surface["volume_ml"], report.volume_ml);
    EXPECT_EQ(greeting["structures"].at(0)["mask"]["source"], "Net 7");
    EXPECT_EQ(here.session.mesh(here.id).find("finished") != std::string::npos, true);
    here.ask({{"call", "undo"}});
    here.session.wait_for_surfaces();
    EXPECT_EQ(json::parse(here.session.greeting())["surfaces"].at(0)["correction"]["voxels"], 0);
}

TEST(CorrectedMask, AHiddenCorrectionIsNone) {
    SessionWithMask here;
    const json drawn = here.draw(11.5);
    const std::vector<std::uint8_t> corrected = here.exported("mask.nii.gz");
    const auto show = [&](bool visible) {
        const json reply =
            here.ask({{"call", "contour.set"}, {"id", drawn["result"]["contour"]["id"]}, {"visible", visible}});
        ASSERT_TRUE(reply.contains("result")) << reply;
        here.session.wait_for_surfaces();
    };
    show(false);
    EXPECT_EQ(here.exported("mask.nii.gz"), here.mask.values);
    EXPECT_EQ(json::parse(here.session.greeting())["surfaces"].at(0)["correction"]["voxels"], 0);
    show(true);
    EXPECT_EQ(here.exported("mask.nii.gz"), corrected);
}

TEST(CorrectedMask, PagesAreToldWhatTheLastStepChanged) {
    SessionWithMask here;
    const auto told = [&] {
        here.session.wait_for_surfaces();
        return json::parse(here.session.greeting())["surfaces"].at(0)["correction"];
    };
    here.draw(11.5);
    const json first = told();
    EXPECT_EQ(first["step"]["voxels"], first["voxels"]);
    EXPECT_GT(first["step"]["more_ml"], 0);
    const json point{{"call", "point.add"}, {"structure", here.id}, {"at", {20, 20, 31}}, {"kind", "interior"}};
    ASSERT_TRUE(here.ask(point).contains("result"));
    const json second = told();
    EXPECT_GT(second["step"]["voxels"], 0);
    EXPECT_LT(second["step"]["voxels"], second["voxels"]);
    here.ask({{"call", "undo"}});
    const json undone = told();
    EXPECT_EQ(undone["step"]["voxels"], second["step"]["voxels"]) << "the way back";
    EXPECT_DOUBLE_EQ(undone["step"]["more_ml"], -second["step"]["more_ml"].get<double>());
}

TEST(CorrectedMask, ImportIsOneStepThatUndoTakesBackAndRedoBringsBack) {
    SessionWithMask here;
    here.session.wait_for_surfaces();
    EXPECT_EQ(here.ask({{"call", "undo"}})["result"]["label"], "Import a mask");
    here.session.wait_for_surfaces();
    EXPECT_TRUE(here.session.state().structures.empty());
    here.ask({{"call", "redo"}});
    here.session.wait_for_surfaces();
    EXPECT_EQ(json::parse(here.session.greeting())["surfaces"].at(0)["stage"], "finished");
    EXPECT_EQ(here.exported("mask.nii.gz"), here.mask.values);
}

TEST(CorrectedMask, LiesBesideStructuresOfContours) {
    SessionWithMask here;
    ContourSet rings;
    rings.name = "Ring";
    rings.contours.push_back({test::kPlane, test::circle(40, 5), true, false});
    here.session.add_structures("Import", {rings});
    here.session.wait_for_surfaces();
    const auto all = json::parse(here.session.statistics())["structures"];
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0]["name"], "Liver");
    EXPECT_EQ(all[0]["voxels"], std::ranges::count(here.mask.values, 1));
    EXPECT_TRUE(json::parse(here.session.compare(here.id, here.id + 1)).contains("dice"));
}

}  // namespace
}  // namespace kontur::viewer
