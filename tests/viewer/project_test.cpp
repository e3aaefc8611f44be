// SPDX-License-Identifier: Apache-2.0
#include "viewer/store/project.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

#include "support/expect_error.h"
#include "support/random.h"
#include "support/temporary_folder.h"
#include "viewer/drawn_contours.h"

namespace kontur::viewer {
namespace {

using kontur::test::TemporaryFolder;
using test::freehand_circle;

const ImageReference kImage{"/images/ct.nii.gz", "8x8x8-int16-0123456789abcdef"};

/// The rows themselves, not pointers to them.
struct Snapshot {
    std::map<Id, Structure> structures;
    std::map<Id, DrawnContour> contours;
    friend bool operator==(const Snapshot&, const Snapshot&) = default;
};

Snapshot snapshot(const Project& project) {
    Snapshot copy{project.state().structures, {}};
    for (const auto& [id, contour] : project.state().contours) copy.contours[id] = *contour;
    return copy;
}

Id add_structure(Project& project, const std::string& name) {
    const Structure structure{project.new_id(), name, "#123456", true};
    project.commit({"Add " + name, {{structure.id, {}, structure}}, {}});
    return structure.id;
}

DrawnContour add_contour(Project& project, Id structure, double radius_mm) {
    DrawnContour contour = as_drawn({test::kPlane, test::circle(20, radius_mm), true, false});
    contour.id = project.new_id();
    contour.structure = structure;
    project.commit({"Draw", {}, {{contour.id, {}, contour}}});
    return contour;
}

/// Adds, changes or removes something.
void edit_at_random(Project& project, Id structure, std::mt19937& random) {
    const State& state = project.state();
    if (state.contours.empty() || random() % 3 == 0) {
        add_contour(project, structure, 1 + static_cast<double>(random() % 20));
        return;
    }
    const DrawnContour before =
        *std::next(state.contours.begin(), static_cast<std::ptrdiff_t>(random() % state.contours.size()))->second;
    if (random() % 3 == 0) return project.commit({"Delete", {}, {{before.id, before, {}}}});
    DrawnContour after = before;
    after.hole = !after.hole;
    for (Vec3& p : after.points) p.x += 0.1 * static_cast<double>(random() % 7);
    after.control.front().at = after.points.front();
    project.commit({"Move", {}, {{before.id, before, after}}});
}

TEST(Project, ReopensWithEverythingAndItsHistory) {
    const TemporaryFolder folder;
    Snapshot before;
    {
        Project project(folder.path() / "a.kontur", kImage);
        EXPECT_TRUE(project.is_new());
        add_contour(project, add_structure(project, "liver"), 12.345678901234567);
        project.save_page_state("{\"layout\":1}");
        before = snapshot(project);
    }
    Project project(folder.path() / "a.kontur", {});
    EXPECT_FALSE(project.is_new());
    EXPECT_EQ(snapshot(project), before);
    EXPECT_EQ(project.image().path, kImage.path);
    EXPECT_EQ(project.image().fingerprint, kImage.fingerprint);
    EXPECT_EQ(project.page_state(), "{\"layout\":1}");
    EXPECT_EQ(project.undo_label(), "Draw");
    EXPECT_EQ(project.redo_label(), std::nullopt);
}

TEST(Project, UndoAndRedoWalkThroughEveryStateAcrossReopening) {
    const TemporaryFolder folder;
    std::mt19937 random = kontur::test::random_of_this_test();
    std::vector<Snapshot> states;
    {
        Project project(folder.path() / "a.kontur", kImage);
        states.push_back(snapshot(project));
        const Id structure = add_structure(project, "liver");
        states.push_back(snapshot(project));
        for (int i = 0; i < 60; ++i) {
            edit_at_random(project, structure, random);
            states.push_back(snapshot(project));
        }
    }
    std::size_t at = states.size() - 1;
    for (int i = 0; i < 20; ++i) {
        Project project(folder.path() / "a.kontur", {});
        EXPECT_EQ(snapshot(project), states[at]);
        for (int move = 0; move < 10; ++move) {
            const bool back = random() % 2;
            const auto moved = back ? project.undo() : project.redo();
            EXPECT_EQ(moved.has_value(), back ? at > 0 : at + 1 < states.size());
            if (moved) at = back ? at - 1 : at + 1;
            ASSERT_EQ(snapshot(project), states[at]);
        }
    }
}

TEST(Project, BordersAreAStepOfTheHistoryLikeAnyOther) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    const Borders shared{.shared = true}, parted{false, {{1, 2, Relation::inside}}};
    {
        Project project(path, kImage);
        EXPECT_EQ(project.state().borders, shared) << "of a new project";
        Commit step{"Share no borders", {}, {}};
        step.borders = BordersChange{project.state().borders, parted};
        EXPECT_FALSE(step.is_empty());
        project.commit(step);
    }
    Project project(path, kImage);
    EXPECT_EQ(project.state().borders, parted);
    EXPECT_EQ(project.undo()->borders->after, shared);
    EXPECT_EQ(project.state().borders, shared);
    project.redo();
    EXPECT_EQ(project.state().borders, parted);
    project.database().run("DELETE FROM setting WHERE key = 'borders'");
    EXPECT_EQ(project.undo()->label, "Share no borders");
}

TEST(Project, UseOfTheImageIsAStepOfTheHistoryToo) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    {
        Project project(path, kImage);
        EXPECT_TRUE(project.state().use_image) << "of a new project";
        Commit step{"Do not use the image", {}, {}};
        step.use_image = UseImageChange{true, false};
        EXPECT_FALSE(step.is_empty());
        project.commit(step);
    }
    {
        Project project(path, kImage);
        EXPECT_FALSE(project.state().use_image);
        EXPECT_TRUE(project.undo()->use_image->after);
        EXPECT_TRUE(project.state().use_image);
    }
    {
        Project project(path, kImage);
        EXPECT_TRUE(project.state().use_image);
        project.database().run("DELETE FROM setting WHERE key = 'use_image'");
    }
    EXPECT_FALSE(Project(path, kImage).state().use_image) << "of before the image was asked: surfaces stay what they were";
}

TEST(Project, WhatItBeginsWithIsKeptAndCannotBeUndone) {
    const TemporaryFolder folder;
    Id first = 0;
    {
        Project project(folder.path() / "a.kontur", kImage);
        first = project.new_id();
        project.begin_with({"", {{first, {}, Structure{first, "Structure 1", "#123456", true}}}, {}});
        add_contour(project, first, 5);
        EXPECT_EQ(project.undo()->label, "Draw");
        EXPECT_FALSE(project.undo_label());
        EXPECT_FALSE(project.undo());
        EXPECT_TRUE(project.redo());
    }
    Project project(folder.path() / "a.kontur", kImage);
    EXPECT_TRUE(project.undo());
    EXPECT_FALSE(project.undo());
    EXPECT_TRUE(project.state().structures.contains(first));
    EXPECT_GT(project.new_id(), first);
}

TEST(Project, AnEditAfterUndoDropsWhatWasUndone) {
    const TemporaryFolder folder;
    Project project(folder.path() / "a.kontur", kImage);
    const Id structure = add_structure(project, "liver");
    const Id dropped = add_contour(project, structure, 5).id;
    project.undo();
    EXPECT_EQ(project.redo_label(), "Draw");
    const Id drawn = add_contour(project, structure, 6).id;
    EXPECT_EQ(project.redo_label(), std::nullopt);
    EXPECT_GT(drawn, dropped);
    EXPECT_FALSE(project.redo());
}

TEST(Project, IdsAreNotUsedAgainAfterReopening) {
    const TemporaryFolder folder;
    Id last = 0;
    {
        Project project(folder.path() / "a.kontur", kImage);
        last = add_contour(project, add_structure(project, "liver"), 5).id;
        project.undo();
    }
    EXPECT_GT(Project(folder.path() / "a.kontur", {}).new_id(), last);
}

TEST(Project, IsOpenInOneProcessOnly) {
    const TemporaryFolder folder;
    const Project first(folder.path() / "a.kontur", kImage);
    // SQLite's locks belong to the process, so another one must try.
    const pid_t child = fork();
    if (child == 0) {
        int code = 1;
        try {
            const Project second(folder.path() / "a.kontur", kImage);
        } catch (const Error& error) {
            code = std::string(error.what()).find("open in another kontur") == std::string::npos ? 2 : 0;
        }
        _exit(code);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Project, ForeignAndDamagedFilesAreRefused) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    std::ofstream(path) << std::string(5000, 'x');
    EXPECT_KONTUR_ERROR(Project(path, kImage), ErrorKind::corrupt_file, "is no kontur project");
    std::filesystem::remove(path);
    { Database(path).run("CREATE TABLE mine (x)"); }
    EXPECT_KONTUR_ERROR(Project(path, kImage), ErrorKind::corrupt_file, "is no kontur project");
    EXPECT_KONTUR_ERROR(image_of_project(folder.path() / "none.kontur"), ErrorKind::corrupt_file, "is no kontur project");
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Project, FilesOfOthersAreRefusedAsTheyAre) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    { Database(path).run("PRAGMA journal_mode = WAL; CREATE TABLE mine (x)"); }
    const std::string foreign = bytes_of(path);
    EXPECT_KONTUR_ERROR(Project(path, kImage), ErrorKind::corrupt_file, "is no kontur project");
    EXPECT_EQ(bytes_of(path), foreign);
    std::filesystem::remove(path);
    { const Project project(path, kImage); }
    { Database(path).run("PRAGMA user_version = 6; PRAGMA journal_mode = WAL"); }
    const std::string newer = bytes_of(path);
    EXPECT_KONTUR_ERROR(Project(path, kImage), ErrorKind::unsupported, "newer kontur");
    EXPECT_EQ(bytes_of(path), newer);
    EXPECT_EQ(folder.entry_count(), 1);
}

TEST(Project, ContoursThatCouldNotBeReadAgainAreRefused) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    {
        Project project(path, kImage);
        const Id structure = add_structure(project, "liver");
        const Snapshot before = snapshot(project);
        DrawnContour many = as_drawn({test::kPlane, test::circle(100'001), true, false});
        DrawnContour far = as_drawn({test::kPlane, test::circle(20, 2e6), true, false});
        for (DrawnContour* contour : {&many, &far}) {
            contour->id = project.new_id();
            contour->structure = structure;
            const Commit step{"Import", {}, {{contour->id, {}, *contour}}};
            const char* limit =
                contour == &many ? "'points' has 100001 points; the limit is 100000" : "the limit is 1e+06 mm";
            EXPECT_KONTUR_ERROR(project.commit(step), ErrorKind::invalid_input, "a contour of liver cannot be kept: ");
            EXPECT_KONTUR_ERROR(project.begin_with(step), ErrorKind::invalid_input, limit);
        }
        EXPECT_EQ(snapshot(project), before);
        EXPECT_EQ(project.undo_label(), "Add liver");
    }
    EXPECT_EQ(Project(path, {}).state().contours.size(), 0u);
}

TEST(Project, AFileThatIsNotThereAnyMoreTakesNoEdits) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur", moved = folder.path() / "b.kontur";
    Project project(path, kImage);
    const Id structure = add_structure(project, "liver");
    const Snapshot before = snapshot(project);
    for (const bool is_replaced : {false, true}) {
        std::filesystem::rename(path, moved);
        if (is_replaced) std::filesystem::copy_file(moved, path);
        EXPECT_KONTUR_ERROR(add_contour(project, structure, 5), ErrorKind::io, "was moved, replaced or deleted");
        EXPECT_KONTUR_ERROR(project.save_page_state("{}"), ErrorKind::io, "was moved, replaced or deleted");
        EXPECT_KONTUR_ERROR(project.undo(), ErrorKind::io, "was moved, replaced or deleted");
        EXPECT_EQ(snapshot(project), before);
        const auto rescued = folder.path() / (is_replaced ? "one.kontur" : "two.kontur");
        project.copy_to(rescued);
        EXPECT_EQ(snapshot(Project(rescued, {})), before);
        std::filesystem::rename(moved, path);
    }
    add_contour(project, structure, 5);
    EXPECT_EQ(project.undo_label(), "Draw") << "it is back";
}

TEST(Project, IsNewUntilSomethingWasInIt) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    EXPECT_TRUE(Project(path, kImage).is_new());
    EXPECT_TRUE(Project(path, kImage).is_new()) << "nothing came of the first start";
    {
        Project project(path, kImage);
        add_structure(project, "liver");
        project.undo();
    }
    EXPECT_FALSE(Project(path, kImage).is_new());
}

TEST(Project, RowsThatMakeNoSenseAreRefusedBySentence) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    for (const char* damage : {"UPDATE contour SET data = '{'", "UPDATE contour SET data = '{}'", "DELETE FROM structure",
                               "UPDATE setting SET value = '-1' WHERE key = 'position'", "DELETE FROM setting",
                               "UPDATE contour SET data = replace(data, '\"index\":0', '\"index\":99')",
                               "UPDATE structure SET data = replace(data, '#123456', 'javascript:')"}) {
        std::filesystem::remove(path);
        {
            Project project(path, kImage);
            add_contour(project, add_structure(project, "liver"), 5);
        }
        { Database(path).run(damage); }
        EXPECT_KONTUR_ERROR(Project(path, {}), ErrorKind::corrupt_file, "damaged");
    }
    std::filesystem::remove(path);
    { const Project project(path, kImage); }
    { Database(path).run("PRAGMA user_version = 6"); }
    EXPECT_KONTUR_ERROR(Project(path, {}), ErrorKind::unsupported, "newer kontur");
}

/// A structure that is a mask, as one step.
Id add_mask(Project& project, const std::shared_ptr<const StoredMask>& mask) {
    Structure structure{project.new_id(), "liver"};
    structure.mask = StructureMask{.hash = mask->hash()};
    Commit step{"Import a mask", {{structure.id, {}, structure}}, {}};
    step.masks = {mask};
    project.commit(step);
    return structure.id;
}

std::shared_ptr<const StoredMask> a_mask() {
    Mask mask{{{7, 5, 3}, {}}, std::vector<std::uint8_t>(105)};
    for (const std::size_t inside : {17, 18, 19, 24, 60}) mask.values[inside] = 1;
    return std::make_shared<const StoredMask>(mask);
}

TEST(Project, KeepsTheMasksThatItsStructuresCorrect) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    const std::shared_ptr<const StoredMask> mask = a_mask();
    Id id = 0;
    {
        Project project(path, kImage);
        EXPECT_EQ(project.database().number("PRAGMA user_version"), 1) << "older versions can open it";
        id = add_mask(project, mask);
        EXPECT_EQ(project.database().number("PRAGMA user_version"), 2);
    }
    {
        Project project(path, {});
        EXPECT_EQ(mask_of(project.state(), project.state().structures.at(id))->mask().values, mask->mask().values);
        EXPECT_TRUE(project.undo());
        EXPECT_TRUE(project.state().structures.empty());
    }
    Project project(path, {});
    EXPECT_TRUE(project.redo());
    EXPECT_EQ(mask_of(project.state(), project.state().structures.at(id))->mask().values, mask->mask().values);
}

TEST(Project, AMaskThatIsNotTheOneItWasIsRefused) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    for (const char* damage :
         {"DELETE FROM mask", "UPDATE mask SET hash = 'x'", "UPDATE mask SET packed = x'00'",
          "UPDATE mask SET header = '{}'", "UPDATE mask SET header = replace(header, '\"high\":[', '\"high\":[7')",
          "UPDATE mask SET header = replace(header, '\"size\":[7', '\"size\":[8')",
          "UPDATE mask SET packed = substr(packed, 1, length(packed) - 1)"}) {
        std::filesystem::remove(path);
        {
            Project project(path, kImage);
            add_mask(project, a_mask());
        }
        { Database(path).run(damage); }
        EXPECT_KONTUR_ERROR(Project(path, {}), ErrorKind::corrupt_file, "damaged");
    }
}

TEST(Project, EveryTruncationIsOpenedOrRefusedBySentence) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur", cut = folder.path() / "cut.kontur";
    {
        Project project(path, kImage);
        const Id structure = add_structure(project, "liver");
        for (int i = 0; i < 10; ++i) add_contour(project, structure, 5 + i);
    }
    const auto size = std::filesystem::file_size(path);
    for (std::uintmax_t length = 0; length < size; length += 509) {
        std::filesystem::copy_file(path, cut, std::filesystem::copy_options::overwrite_existing);
        std::filesystem::resize_file(cut, length);
        try {
            Project project(cut, kImage);
            while (project.undo()) {
            }
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::corrupt_file) << length << ": " << error.what();
        }
    }
}

TEST(Project, ACopyHoldsTheSame) {
    const TemporaryFolder folder;
    Project project(folder.path() / "a.kontur", kImage);
    add_contour(project, add_structure(project, "liver"), 5);
    project.copy_to(folder.path() / "b.kontur");
    Project copy(folder.path() / "b.kontur", {});
    EXPECT_EQ(snapshot(copy), snapshot(project));
    EXPECT_EQ(copy.undo_label(), "Draw");
}

TEST(Project, AFullDiskIsToldAndChangesNothing) {
    const TemporaryFolder folder;
    Project project(folder.path() / "a.kontur", kImage);
    const Id structure = add_structure(project, "liver");
    const Snapshot before = snapshot(project);
    {
        Database& database = project.database();
        database.run("PRAGMA max_page_count = 1");
    }
    std::string reason;
    try {
        for (int i = 0; i < 100; ++i) add_contour(project, structure, 5);
    } catch (const Error& error) {
        reason = error.what();
    }
    EXPECT_NE(reason.find("the disk is full"), std::string::npos) << reason;
    project.database().run("PRAGMA max_page_count = 100000");
    while (project.undo_label() == "Draw") project.undo();
    EXPECT_EQ(snapshot(project), before);
}

/// A process that draws until it is killed, and tells the number of contours each time that a commit has returned.
[[noreturn]] void draw_until_killed(const std::filesystem::path& path, int pipe_end) {
    Project project(path, {});
    const Id structure = project.state().structures.begin()->first;
    for (;;) {
        add_contour(project, structure, 1 + static_cast<double>(project.state().contours.size() % 20));
        const auto count = static_cast<std::uint32_t>(project.state().contours.size());
        if (write(pipe_end, &count, sizeof count) != sizeof count) _exit(0);
    }
}

TEST(Project, NoAcknowledgedEditIsLostByKill9) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.kontur";
    {
        Project project(path, kImage);
        add_structure(project, "liver");
    }
    std::mt19937 random = kontur::test::random_of_this_test();
    std::uint32_t acknowledged = 0;
    // A flush to the disk for each edit makes this slow; kill_test.py does it with the whole program, and 1000 times if
    // asked.
    for (int kill_number = 0; kill_number < 8; ++kill_number) {
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        const pid_t child = fork();
        if (child == 0) draw_until_killed(path, ends[1]);
        close(ends[1]);
        for (unsigned i = 0; i < 1 + random() % 5; ++i)
            if (std::uint32_t count = 0; read(ends[0], &count, sizeof count) == sizeof count) acknowledged = count;
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 2000));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        for (std::uint32_t count = 0; read(ends[0], &count, sizeof count) == sizeof count;) acknowledged = count;
        close(ends[0]);

        Project project(path, {});
        const auto found = static_cast<std::uint32_t>(project.state().contours.size());
        ASSERT_GE(found, acknowledged) << "after kill " << kill_number;
        ASSERT_LE(found, acknowledged + 1) << "after kill " << kill_number;
        ASSERT_EQ(project.database().number("SELECT count(*) FROM history"), found + 1);
        ASSERT_EQ(project.database().number("SELECT integrity_check = 'ok' FROM pragma_integrity_check"), 1);
    }
}

}  // namespace
}  // namespace kontur::viewer
