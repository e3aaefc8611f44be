// SPDX-License-Identifier: Apache-2.0
#include "viewer/store/places.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "viewer/store/recent.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using kontur::test::TemporaryFolder;
using nlohmann::json;

void write(const fs::path& file, const std::string& bytes = "x") { std::ofstream(file, std::ios::binary) << bytes; }

std::vector<std::string> names(const json& list) {
    std::vector<std::string> found;
    for (const json& one : list) found.push_back(one.at("name"));
    return found;
}

/// A place with what may be shown of it, and beside it a folder that is none.
struct Disk {
    Disk() {
        for (const char* folder : {"place/a/deep", "place/.hidden", "place/B", "outside", "places"})
            fs::create_directories(root / folder);
        write(root / "place/scan.NII.GZ");
        write(root / "place/work.kontur");
        write(root / "place/notes.txt");
        write(root / "place/.secret.nii");
        write(root / "place/.hidden/scan.nii");
        write(root / "outside/scan.nii");
        write(root / "places/scan.nii");
        fs::create_symlink(root / "outside", root / "place/link");
        fs::create_symlink(root / "outside/scan.nii", root / "place/link.nii");
        fs::create_symlink(root / "place/a", root / "place/inner");
        fs::create_symlink(root / "place/none", root / "place/dangling.nii");
    }

    TemporaryFolder folder;
    fs::path root = fs::canonical(folder.path());
    Places places() const {
        return Places(std::vector<Place>{{"Place", root / "place"}, {"None", root / "none"}, {"Again", root / "place"}});
    }
};

TEST(Places, AreFoldersThatAreThereEachOnce) {
    const Disk disk;
    const Places places = disk.places();
    ASSERT_EQ(places.all().size(), 1u);
    EXPECT_EQ(places.all().front().name, "Place");
}

TEST(Places, ListWhatCanBeOpenedAndNothingHiddenOrOutside) {
    const Disk disk;
    const json listed = disk.places().list((disk.root / "place").string());
    EXPECT_EQ(names(listed["folders"]), (std::vector<std::string>{"a", "B", "inner"}));
    EXPECT_EQ(names(listed["files"]), (std::vector<std::string>{"scan.NII.GZ", "work.kontur"}));
    EXPECT_EQ(listed["files"][0]["kind"], "image");
    EXPECT_EQ(listed["files"][1]["kind"], "project");
    EXPECT_EQ(listed["left_out"], 3) << "three links";
    EXPECT_EQ(listed["dicom"], "none");
    EXPECT_TRUE(listed["parent"].is_null());
    EXPECT_EQ(disk.places().list((disk.root / "place/a").string())["parent"], (disk.root / "place").string());
}

TEST(Places, FindDicomHereAndBelow) {
    const Disk disk;
    write(disk.root / "place/a/deep/slice", std::string(128, '\0') + "DICM" + std::string(200, '\0'));
    EXPECT_EQ(disk.places().list((disk.root / "place").string())["dicom"], "below");
    const json deep = disk.places().list((disk.root / "place/a/deep").string());
    EXPECT_EQ(deep["dicom"], "here");
    EXPECT_EQ(deep["files"], json::array()) << "slices are no files to open one by one";
}

TEST(Places, RefuseWhatLiesOutside) {
    const Disk disk;
    const Places places = disk.places();
    const std::string place = (disk.root / "place").string();
    for (const std::string& path :
         {(disk.root / "outside/scan.nii").string(), (disk.root / "places/scan.nii").string(), disk.root.string(),
          place + "/../outside/scan.nii", place + "/link/scan.nii", place + "/link.nii", place + "/.hidden/scan.nii",
          place + "/.secret.nii", place + "/a/../../outside", std::string("/etc/passwd"), std::string("/no/such/file"),
          std::string("scan.nii"), std::string(), std::string("/")})
        EXPECT_KONTUR_ERROR(places.resolved(path), ErrorKind::invalid_input, "lies outside of the folders");
    EXPECT_KONTUR_ERROR(places.resolved(place + "/none.nii"), ErrorKind::io, "does not exist");
    EXPECT_KONTUR_ERROR(places.list(place + "/scan.NII.GZ"), ErrorKind::io, "is no folder");
    EXPECT_EQ(places.resolved(place + "/a/../scan.NII.GZ"), disk.root / "place/scan.NII.GZ");
    EXPECT_EQ(places.resolved(place + "/inner/deep"), disk.root / "place/a/deep");
    EXPECT_KONTUR_ERROR(Places().resolved(place), ErrorKind::invalid_input, "lies outside");
}

TEST(Places, TheTildeIsTheHomeFolderAndANulIsRefused) {
    const Disk disk;
    const std::string place = (disk.root / "place").string();
    const char* known = std::getenv("HOME");
    const std::string home = known ? known : "";
    setenv("HOME", place.c_str(), 1);
    EXPECT_EQ(disk.places().resolved("~"), disk.root / "place");
    EXPECT_EQ(disk.places().resolved("~/a/deep"), disk.root / "place/a/deep");
    EXPECT_KONTUR_ERROR(disk.places().resolved("~other"), ErrorKind::invalid_input, "lies outside");
    if (known) setenv("HOME", home.c_str(), 1);
    else unsetenv("HOME");
    EXPECT_KONTUR_ERROR(disk.places().resolved(place + std::string("/a\0.nii", 7)), ErrorKind::invalid_input, "NUL");
    EXPECT_THROW(disk.places().resolved(place + "/none.nii"), PathMissing);
    EXPECT_KONTUR_ERROR(disk.places().resolved("/etc/passwd"), ErrorKind::invalid_input, "kontur open /etc/passwd");
}

TEST(Places, AllOfTheDiskIsAPlaceLikeOthers) {
    const Disk disk;
    const Places all(std::vector<Place>{{"Disk", "/"}});
    EXPECT_TRUE(all.list("/")["parent"].is_null());
    EXPECT_EQ(all.resolved((disk.root / "outside").string()), disk.root / "outside");
}

TEST(RecentProjects, TheLatestIsFirstAndEachIsThereOnce) {
    const Disk disk;
    const fs::path file = disk.root / "recent.json";
    const RecentProject one{disk.root / "place/work.kontur", "Doe, Jane", "/images/ct", {}};
    const RecentProject gone{disk.root / "place/gone.kontur", "Gone", "/images/mr", {}};
    RecentProjects recent(file);
    EXPECT_TRUE(recent.all().empty());
    recent.add(one);
    recent.add(gone);
    recent.add({disk.root / "outside/scan.nii", "Other", "x", {}});
    recent.add(one);
    const auto all = RecentProjects(file).all();
    ASSERT_EQ(all.size(), 2u) << "what is not in its place is left out";
    EXPECT_EQ(all[0].title, "Doe, Jane");
    EXPECT_EQ(all[0].time.size(), 20u);
    EXPECT_TRUE(recent.contains(one.project));
    EXPECT_FALSE(recent.contains(gone.project));
    EXPECT_EQ(fs::status(file).permissions() & fs::perms::all, fs::perms::owner_read | fs::perms::owner_write);
}

TEST(RecentProjects, ADamagedListCountsAsEmpty) {
    const Disk disk;
    const fs::path file = disk.root / "recent.json";
    for (const char* text : {"", "{", "[1]", "[{}]", "{\"a\": 1}", "[[[[", "null"}) {
        write(file, text);
        EXPECT_TRUE(RecentProjects(file).all().empty()) << text;
    }
    RecentProjects(file).add({disk.root / "place/work.kontur", "a", "b", {}});
    EXPECT_EQ(RecentProjects(file).all().size(), 1u);
    RecentProjects none{fs::path()};
    none.add({disk.root / "place/work.kontur", "a", "b", {}});
    EXPECT_TRUE(none.all().empty());
}

}  // namespace
}  // namespace kontur::viewer
