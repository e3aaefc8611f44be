// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/read_provenance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "kontur/io/contours.h"
#include "kontur/io/image.h"
#include "kontur/io/meshes/mesh.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

const Provenance kMade{{"contours_sha256", std::string(64, 'a')},
                       {"made_by", "kontur convert"},
                       {"note", R"(Läsion: "a\nb"; c\d: e)"},
                       {"options", "roi=a b=c"}};

Provenance sorted(Provenance provenance) {
    std::sort(provenance.begin(), provenance.end());
    return provenance;
}

void write(const fs::path& path, std::string_view bytes) { std::ofstream(path, std::ios::binary) << bytes; }

const Mask kMask{{{2, 3, 4}, {}}, std::vector<std::uint8_t>(24, 1)};
const TriangleMesh kMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}};

/// Writes a file of this name, which says that it was made so.
void write_sample(const fs::path& path, const Provenance& made) {
    const std::string extension = path.extension().string();
    if (extension == ".json") write_contours(path, {}, made);
    else if (extension == ".ply" || extension == ".obj" || extension == ".stl" || extension == ".vtk" || extension == ".vtp")
        write_mesh(path, kMesh, made);
    else write_mask(path, kMask, {}, made);
}

TEST(ReadProvenance, FindsWhatTheWritersWrote) {
    const test::TemporaryFolder folder;
    for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.seg.nrrd", "a.json", "a.mrk.json", "a.ply", "a.obj", "a.vtp",
                             "a.mgh", "a.mgz"}) {
        write_sample(folder / name, kMade);
        EXPECT_EQ(sorted(read_provenance(folder / name)), kMade) << name;
        write_sample(folder / name, {});
        EXPECT_EQ(read_provenance(folder / name), Provenance{}) << name;
    }
}

TEST(ReadProvenance, IsOneTextWhereTheFormatHoldsItShortened) {
    const test::TemporaryFolder folder;
    for (const char* name : {"a.mha", "a.stl", "a.vtk"}) {
        write_sample(folder / name, kMade);
        const Provenance found = read_provenance(folder / name);
        ASSERT_EQ(found.size(), 1u) << name;
        EXPECT_EQ(found[0].first, "shortened");
        EXPECT_TRUE(found[0].second.starts_with("contours_sha256=aaaaaaaaaaaa made_by=kontur")) << found[0].second;
        write_sample(folder / name, {});
        EXPECT_EQ(read_provenance(folder / name), Provenance{}) << name;
    }
}

TEST(ReadProvenance, TakesNothingThatCouldNotBeWrittenAgain) {
    const test::TemporaryFolder folder;
    write(folder / "a.json",
          R"({"provenance": {"two words": "x", "": "y", "made_by": "a\nkontur_b:=c", "n": 3, "deep": {}}})");
    EXPECT_EQ(read_provenance(folder / "a.json"), (Provenance{{"made_by", "a?kontur_b:=c"}}));
    write(folder / "a.obj", "# kontur made_by: \xff\x1b[2J\n# kontur no colon\n# other made_by: x\n");
    EXPECT_EQ(read_provenance(folder / "a.obj"), (Provenance{{"made_by", "??[2J"}}));
}

TEST(ReadProvenance, IsEmptyForOtherFilesAndFolders) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(read_provenance(fs::path(folder / "a").parent_path()), Provenance{});
    for (const char* name : {"a.ply", "a.obj", "a.stl", "a.vtk", "a.vtp", "a.txt", "a.mha"}) {
        write(folder / name, "kontur is not the author");
        EXPECT_EQ(read_provenance(folder / name), Provenance{}) << name;
    }
    write(folder / "a.json", "[1]");
    EXPECT_EQ(read_provenance(folder / "a.json"), Provenance{});
    EXPECT_KONTUR_ERROR(read_provenance(folder / "missing.nii"), ErrorKind::io, "missing.nii");
}

TEST(ReadProvenance, AnExtensionThatLiesAboutItsSizeSaysNothing) {
    const test::TemporaryFolder folder;
    write_sample(folder / "a.nii", kMade);
    std::ifstream file(folder / "a.nii", std::ios::binary);
    const std::string sound{std::istreambuf_iterator<char>(file), {}};
    constexpr std::size_t kExtensionStart = 352;
    using namespace std::string_view_literals;
    for (const std::string_view size : {"\0\0\0\0"sv, "\7\0\0\0"sv, "\xff\xff\0\0"sv, "\xff\xff\xff\xff"sv}) {
        write(folder / "b.nii", std::string(sound).replace(kExtensionStart, size.size(), size));
        EXPECT_EQ(read_provenance(folder / "b.nii"), Provenance{});
    }
}

}  // namespace
}  // namespace kontur
