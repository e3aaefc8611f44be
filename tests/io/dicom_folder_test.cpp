// SPDX-License-Identifier: Apache-2.0
// Folders as archives, disks and interrupted copies leave them.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>

#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/file_digest.h"
#include "kontur/io/image.h"
#include "support/damage.h"
#include "support/dicom_series_fixture.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

using test::notes_mention;
using Sentences = std::vector<std::string>;

class DicomFolderTest : public test::DicomSeriesTest {
protected:
    /// The slices of a case from the lowest to the highest.
    std::vector<fs::path> slices(const fs::path& files) { return read_dicom_grid(files).series.files; }

    std::string uid_of(const fs::path& files) { return list_dicom_series(files).at(0).series_uid; }

    static void cut(const fs::path& from, const fs::path& to, std::size_t bytes) {
        test::write_bytes(to, test::read_bytes(from).substr(0, bytes));
    }
};

TEST_F(DicomFolderTest, AFileThatBreaksOffBeforeItsSeriesBlocksNothing) {
    const fs::path files = make("axial");
    cut(slices(make("oblique")).front(), files / "stray.dcm", 380);
    const DicomVolume unasked = check("axial");
    EXPECT_TRUE(notes_mention(unasked.warnings, "left out 1 damaged file that may belong to the volume: "))
        << "named as slices";
    EXPECT_TRUE(notes_mention(unasked.warnings, "stray.dcm: not a complete DICOM file")) << "says which, and why";
    EXPECT_EQ(check("axial", {.series_uid = uid_of(files)}).warnings, unasked.warnings);
    EXPECT_EQ(read_dicom_grid(slices(files)[4]).grid, unasked.image.grid);
    fs::rename(files / "stray.dcm", files / "stray.tmp");
    const DicomVolume named = check("axial", {.series_uid = uid_of(files)});
    EXPECT_EQ(named.notes, Sentences{"left out 1 damaged file of unknown series: stray.tmp"});
    EXPECT_TRUE(named.warnings.empty());
    EXPECT_EQ(check("axial").warnings.size(), 1u) << "not named like a slice, but nobody said which series is meant";
    EXPECT_REFUSED(refusal(files / "stray.tmp"), corrupt_file, "stray.tmp: not a complete DICOM file");
}

TEST_F(DicomFolderTest, AFileThatBreaksOffBehindItsSeriesBlocksThatOneOnly) {
    const fs::path files = make("axial");
    const fs::path other = slices(make("oblique")).front();
    const std::size_t header = test::read_bytes(other).size() - 400;  // in front of the pixels
    cut(other, files / "stray.dcm", header);
    const DicomVolume named = check("axial", {.series_uid = uid_of(files)});
    EXPECT_EQ(named.notes, Sentences{"left out 1 damaged file of other series: stray.dcm"});
    EXPECT_TRUE(named.warnings.empty());
    EXPECT_EQ(check("axial").warnings.size(), 1u);
    const fs::path own = slices(files).back();
    cut(own, own, header);
    EXPECT_REFUSED(refusal(files), corrupt_file, own.filename().string() + ": not a complete DICOM file");
    EXPECT_REFUSED(refusal(files, {.series_uid = uid_of(files)}), corrupt_file, own.filename().string());
    EXPECT_REFUSED(refusal(slices(make("coronal")).front().parent_path().parent_path().parent_path() / "axial" / "dicom"),
                   corrupt_file, own.filename().string());
}

TEST_F(DicomFolderTest, WhatIsNamedLikeTheSlicesAndIsNoDicomGivesAWarning) {
    for (const std::size_t bytes : {0, 100, 131}) {
        const fs::path files = make("axial");
        const fs::path last = slices(files).back();
        cut(last, last, bytes);
        const Sentences expected{"left out 1 file, named like the slices but no DICOM: " + last.filename().string() + " (" +
                                 std::to_string(bytes) + " bytes); the volume may lack a slice"};
        EXPECT_EQ(read_dicom_grid(files).warnings, expected);
        const DicomVolume volume = read_dicom_series(files);
        EXPECT_EQ(volume.warnings, expected);
        EXPECT_EQ(volume.image.grid.size.k, 8);
        Sentences notes, warnings;
        ReadImageOptions options;
        options.on_note = [&](std::string_view note) { notes.emplace_back(note); };
        read_grid(files, options);
        EXPECT_EQ(notes, expected) << "for who takes notes only";
        notes.clear();
        options.on_warning = [&](std::string_view warning) { warnings.emplace_back(warning); };
        read_image(files, options);
        EXPECT_EQ(warnings, expected);
        EXPECT_TRUE(notes.empty());
        fs::remove_all(files.parent_path());
    }
}

TEST_F(DicomFolderTest, NamesWithoutExtensionsAreAlikeIfTheirNumbersAlone) {
    const fs::path files = make("axial");
    int number = 0;
    for (const fs::path& slice : slices(files)) fs::rename(slice, files / ("IM-0001-000" + std::to_string(number++)));
    test::write_bytes(files / "README", "");
    EXPECT_TRUE(read_dicom_grid(files).warnings.empty());
    test::write_bytes(files / "IM-0002-0010", "");
    EXPECT_EQ(read_dicom_grid(files).warnings.size(), 1u);
}

TEST_F(DicomFolderTest, LeavesOutIdenticalCopiesAndRefusesDifferentOnes) {
    const fs::path files = make("duplicated");
    const DicomVolume volume = check("duplicated");
    ASSERT_EQ(volume.notes.size(), 1u);
    EXPECT_TRUE(notes_mention(volume.notes, "left out 1 file (identical copy of another): f"));
    const DicomVolume named = read_dicom_series(files / "copy.dcm");
    EXPECT_EQ(named.image.grid, volume.image.grid) << "a copy stands for its series";
    const fs::path copied = slices(files)[5];
    EXPECT_EQ(read_dicom_series(copied).series.files[5], copied) << "the named one is kept";
    std::string bytes = test::read_bytes(files / "copy.dcm");
    bytes.back() ^= 1;
    test::write_bytes(files / "copy.dcm", bytes);
    EXPECT_REFUSED(refusal(files), invalid_input, "copy.dcm and ");
    EXPECT_REFUSED(refusal(files), invalid_input, "have the same SOP Instance UID 1.2.");
}

TEST_F(DicomFolderTest, FindsSeriesInFoldersBelow) {
    const fs::path files = make("axial");
    const Grid grid = read_dicom_grid(files).grid;
    const fs::path disk = folder_ / "disk";
    int number = 0;
    for (const fs::path& slice : slices(files)) {  // as on disks that hold so many files a folder
        const fs::path below = disk / "DICOM" / "ST000001" / (number < 5 ? "SE01" : "SE02");
        fs::create_directories(below);
        fs::copy_file(slice, below / ("IM" + std::to_string(number++)));
    }
    test::write_bytes(disk / "README.TXT", "a disk");
    fs::create_directory_symlink(disk, disk / "DICOM" / "again");
    EXPECT_TRUE(looks_like_dicom(disk));
    EXPECT_EQ(list_dicom_series(disk).size(), 1u);
    const DicomGrid found = read_dicom_grid(disk);
    EXPECT_EQ(found.grid, grid);
    EXPECT_TRUE(notes_mention(found.notes, "left out 1 file (link to a folder, which is not followed): DICOM/again"));
    const std::string before = file_sha256(disk);
    std::string bytes = test::read_bytes(found.series.files[3]);
    bytes.back() ^= 1;
    test::write_bytes(found.series.files[3], bytes);
    EXPECT_NE(file_sha256(disk), before) << "the digest is that of all that is read";
    test::write_bytes(disk / "DICOM" / "ST000001" / "SE02" / "IM9", "");
    EXPECT_EQ(read_dicom_grid(disk).warnings.size(), 1u);
}

TEST_F(DicomFolderTest, AFolderWithImagesStandsForItselfAlone) {
    const fs::path files = make("axial");
    const std::string digest = file_sha256(files);
    fs::create_directories(files / "out" / "old");
    fs::copy(make("oblique"), files / "out" / "old", fs::copy_options::recursive);
    const DicomVolume volume = check("axial");
    EXPECT_EQ(volume.notes, Sentences{"images are not looked for in out, because the folder itself holds some"});
    EXPECT_EQ(file_sha256(files), digest);
}

TEST_F(DicomFolderTest, RefusesFoldersInEachOtherWithoutEnd) {
    fs::path deep = folder_ / "deep";
    for (int n = 0; n < 40; ++n) deep /= "f";
    fs::create_directories(deep);
    EXPECT_REFUSED(refusal(folder_ / "deep"), too_large, "its folders lie in each other more than 30 deep");
}

TEST_F(DicomFolderTest, NamesTheNewerSyntaxAndReadsTheSeriesBesideIt) {
    const fs::path files = make("axial");
    const std::string own = uid_of(files);
    const Grid grid = read_dicom_grid(files).grid;
    for (const auto& [name, syntax] :
         {std::pair("htj2k", "High-Throughput JPEG 2000 (Lossless Only)"), std::pair("jpeg_xl", "JPEG XL Lossless"),
          std::pair("private", "1.2.826.0.1.3680043.9.1")}) {
        const fs::path other = make(name);
        EXPECT_REFUSED(refusal(other), unsupported, std::string("the compression '") + syntax + "' is not supported");
        EXPECT_EQ(read_dicom_grid(other).grid, grid) << "the header is as ever";
        fs::copy_file(slices(other).front(), files / name);
    }
    EXPECT_EQ(check("axial", {.series_uid = own}).image.grid, grid);
}

TEST_F(DicomFolderTest, ReadsElementsOfUnknownTypePaddingAndBareFiles) {
    for (const char* name : {"unknown_types", "padded", "trailing", "filled", "bare", "bare_data", "bare_implicit"}) {
        SCOPED_TRACE(name);
        const DicomVolume volume = read_and_check(name);
        EXPECT_TRUE(volume.warnings.empty());
        EXPECT_TRUE(volume.notes.empty());
        EXPECT_EQ(volume.series.modality, "CT");
    }
}

TEST_F(DicomFolderTest, ReadsStructureSetsAndSegmentationsWithoutPreamble) {
    const fs::path bare = folder_ / "bare.dcm";
    const auto strip = [&](const std::string& script, const std::string& name, const Sentences& more) {
        const fs::path whole = folder_ / "whole.dcm";
        Sentences arguments{name, whole.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(test::run_python(script, arguments).exit_code, 0);
        test::write_bytes(bare, test::read_bytes(whole).substr(132));
        return whole;
    };
    for (const char* name : {"good", "explicit"}) {
        const StructureSet whole = read_rtstruct(strip("make_rtstruct.py", name, {}));
        EXPECT_TRUE(is_rtstruct(bare));
        const StructureSet read = read_rtstruct(bare);
        ASSERT_EQ(read.rois.size(), whole.rois.size());
        for (std::size_t n = 0; n < read.rois.size(); ++n)
            EXPECT_EQ(read.rois[n].contours.contours.size(), whole.rois[n].contours.contours.size());
    }
    const fs::path seg = strip("make_dicom_seg.py", "shuffled", {(folder_ / "truth").string()});
    EXPECT_TRUE(is_dicom_seg(bare));
    EXPECT_EQ(read_dicom_seg(bare).labels.samples, read_dicom_seg(seg).labels.samples);
}

TEST_F(DicomFolderTest, WhatFollowsThePixelsIsPaddingOnlyIfItIsOneByteOverAndOver) {
    const fs::path files = make("padded");
    const fs::path slice = slices(files).front();
    std::string bytes = test::read_bytes(slice);
    bytes[bytes.size() - 60] = 7;
    test::write_bytes(slice, bytes);
    EXPECT_REFUSED(refusal(files), corrupt_file, "the pixel data has 464 bytes, the header claims 336");
}

TEST_F(DicomFolderTest, RefusesTwoPatientsInOneSeriesNamingBoth) {
    const fs::path files = make("patients");
    for (const char* part : {" has images of two patients: f", "names 'P1', f", "names 'P2'"})
        EXPECT_REFUSED(refusal(files), invalid_input, part);
}

TEST_F(DicomFolderTest, ANamedFileThatMakesNoVolumeSaysWhy) {
    const fs::path files = make("company");
    EXPECT_REFUSED(
        refusal(files / "capture.dcm"), invalid_input,
        "capture.dcm makes no volume: image without a position in space; ImagePositionPatient (0020,0032) is missing");
    EXPECT_REFUSED(refusal(files / "structures.dcm"), invalid_input, "structures.dcm makes no volume: RTSTRUCT");
    EXPECT_REFUSED(refusal(files / "README.txt"), invalid_input, "README.txt makes no volume: not a DICOM file");
}

}  // namespace
}  // namespace kontur
