// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/metaimage.h"

#include "image_cases.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;
using test::expect_error;

/// A raw file of 2 x 2 x 2 bytes, by its header lines.
class MetaImageLines : public ::testing::Test {
protected:
    void set(const std::string& field, const std::string& value) { fields[field] = value; }

    Image read() {
        std::string text;
        for (const auto& [field, value] : fields)
            if (field != "ElementDataFile") text += field + " = " + value + "\n";
        text += "ElementDataFile = " + fields["ElementDataFile"] + "\n";
        test::put_content(folder / file, text + voxels);
        return read_metaimage(folder / file, options);
    }

    void expect_refused(ErrorKind kind, const std::string& part) {
        expect_error(kind, part, [&] { read(); });
    }

    test::TemporaryFolder folder;
    std::string file = "a.mha";
    std::map<std::string, std::string> fields{{"ObjectType", "Image"},      {"NDims", "3"},
                                              {"DimSize", "2 2 2"},         {"ElementSpacing", "1 1 1"},
                                              {"Offset", "0 0 0"},          {"TransformMatrix", "1 0 0 0 1 0 0 0 1"},
                                              {"ElementType", "MET_UCHAR"}, {"ElementDataFile", "LOCAL"}};
    std::string voxels = "12345678";
    ReadImageOptions options;
};

TEST_F(MetaImageLines, EveryTruncatedPrefixOfRawIsRefused) {
    ASSERT_NO_THROW(read());
    test::expect_prefixes_refused(folder / "a.mha", folder / "part.mha", [](const fs::path& path) { read_metaimage(path); });
}

TEST_F(MetaImageLines, FramesAndChannelsNeedAChoice) {
    voxels = "a1b2c3d4e5f6g7h8";
    const auto expect_second = [&](const std::string& expected) {
        options.frame.reset();
        expect_refused(ErrorKind::unsupported, "2 frames; choose one with the option frame (1 to 2)");
        options.frame = 2;
        EXPECT_EQ(read().samples, Image::Samples(std::vector<std::uint8_t>(expected.begin(), expected.end())));
    };
    set("ElementNumberOfChannels", "2");
    expect_second("12345678");
    fields.erase("ElementNumberOfChannels");
    set("NDims", "4");
    set("DimSize", "2 2 2 2");
    set("ElementSpacing", "1 1 1 30");
    set("Offset", "0 0 0 0");
    set("TransformMatrix", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
    expect_second("e5f6g7h8");
    set("TransformMatrix", "1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1");
    expect_refused(ErrorKind::unsupported, "mixes space");
}

TEST_F(MetaImageLines, DefaultsOfTheFormatHoldButSpacingNeedsConsent) {
    fields.erase("TransformMatrix");
    fields.erase("Offset");
    EXPECT_EQ(read().grid.index_to_mm, Affine3{});
    fields.erase("ElementSpacing");
    set("ElementSize", "2 3 4");
    EXPECT_EQ(read().grid.spacing_mm(), (Vec3{2, 3, 4}));
    fields.erase("ElementSize");
    expect_refused(ErrorKind::unsupported, "allow_missing_geometry");
    options.allow_missing_geometry = true;
    EXPECT_EQ(read().grid.spacing_mm(), (Vec3{1, 1, 1}));
}

TEST_F(MetaImageLines, LiesAreRefused) {
    const auto original = fields;
    const auto spoil = [&](const std::string& field, const std::string& value, ErrorKind kind, const std::string& part) {
        fields = original;
        set(field, value);
        expect_refused(kind, part);
    };
    spoil("DimSize", "2 0 2", ErrorKind::corrupt_file, "0 voxels along axis 2");
    spoil("DimSize", "2 2 -2", ErrorKind::corrupt_file, "-2 voxels along axis 3");
    spoil("DimSize", "2 2", ErrorKind::corrupt_file, "3 integers are expected");
    spoil("DimSize", "2147483648 1 1", ErrorKind::corrupt_file, "declares 2147483648 bytes of voxels, but only 8 are there");
    spoil("DimSize", "2147483648 2 1", ErrorKind::too_large, "4294967296 voxels");
    spoil("ElementSpacing", "nan 1 1", ErrorKind::corrupt_file, "not finite");
    spoil("ElementSpacing", "0 1 1", ErrorKind::corrupt_file, "linearly dependent");
    spoil("TransformMatrix", "1 0 0 0 1 0 1 1 0", ErrorKind::corrupt_file, "linearly dependent");
    spoil("TransformMatrix", "1 0 0 0 1 0 1 1", ErrorKind::corrupt_file, "9 numbers are expected");
    spoil("Offset", "0 inf 0", ErrorKind::corrupt_file, "not finite");
    spoil("Origin", "0 0 1", ErrorKind::corrupt_file, "twice, with two values");
    spoil("ElementType", "MET_STRING", ErrorKind::unsupported, "MET_STRING");
    spoil("ElementNumberOfChannels", "0", ErrorKind::corrupt_file, "0 channels");
    spoil("NDims", "2", ErrorKind::unsupported, "2 axes");
    spoil("ObjectType", "Tube", ErrorKind::unsupported, "Tube");
    spoil("BinaryData", "maybe", ErrorKind::corrupt_file, "True or False");
    spoil("HeaderSize", "100", ErrorKind::corrupt_file, "ends after");
    spoil("HeaderSize", "-2", ErrorKind::corrupt_file, "-2");
    spoil("CompressedData", "True", ErrorKind::corrupt_file, "compressed data are damaged");
    spoil("ElementToIntensityFunctionSlope", "2", ErrorKind::unsupported, "rescaled");
}

TEST_F(MetaImageLines, TextHoldsAsManyNumbersAsDeclared) {
    set("BinaryData", "False");
    set("ElementType", "MET_FLOAT");
    voxels = "1 2 3 4 5 6 7 " + std::string(60, '0') + "8.25\n \n";
    EXPECT_EQ(sample(read(), 7), 8.25) << "64 characters";
    voxels = "1 2 3 4 5 6 7 " + std::string(61, '0') + "8.25";
    expect_refused(ErrorKind::corrupt_file,
                   "the number \"0000000000000000...\" among its voxels has more than 64 characters");
    voxels = "1 2 3 4 5 6 7 8 9";
    expect_refused(ErrorKind::corrupt_file, "\"9\" follows the last of its declared voxels");
    voxels = "1 2 3 4 5 6 7";
    expect_refused(ErrorKind::corrupt_file, "");
}

TEST_F(MetaImageLines, IntegersStayExactOrAreRefused) {
    set("BinaryData", "False");
    set("ElementType", "MET_ULONG_LONG");
    voxels = "0 1 2 3 4 5 6 4294967296";
    EXPECT_EQ(sample(read(), 7), 4294967296.0);
    for (const char* value : {"4000000001", "9007199254740993", "18446744073709551615"}) {
        voxels = std::string("0 1 2 3 4 5 6 ") + value;
        expect_refused(ErrorKind::unsupported, "is beyond 32-bit integers, and a float does not hold it exactly");
    }
    voxels = "0 1 2 3 4 5 6 4000000001";
    expect_refused(ErrorKind::unsupported, "the voxel value 4000000001 is");
}

TEST_F(MetaImageLines, TwoNamesOfOneFieldMayAgree) {
    set("BinaryDataByteOrderMSB", "False");
    set("ElementByteOrderMSB", "False");
    EXPECT_NO_THROW(read());
    set("ElementByteOrderMSB", "True");
    expect_refused(ErrorKind::corrupt_file, "\"BinaryDataByteOrderMSB\" twice, with two values");
}

TEST_F(MetaImageLines, BytesBehindTheVoxelsAreTold) {
    std::vector<std::string> notes;
    options.on_note = [&](std::string_view note) { notes.emplace_back(note); };
    file = "a.mhd";
    set("ElementDataFile", "./a.raw");
    test::put_content(folder / "a.raw", voxels);
    read();
    EXPECT_TRUE(notes.empty());
    test::put_content(folder / "a.raw", voxels + voxels);
    read();
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_TRUE(notes[0].ends_with("its header declares 8 bytes of voxels, and 16 are there; the rest is left out"));
}

TEST_F(MetaImageLines, WrongCompressedSizeIsRefused) {
    set("CompressedData", "True");
    for (const char* size : {"9", "-1", "9223372036854775807"}) {
        set("CompressedDataSize", size);
        expect_refused(ErrorKind::corrupt_file, std::string("CompressedDataSize is ") + size);
    }
}

TEST_F(MetaImageLines, DataFilesElsewhereAreRefused) {
    set("ElementDataFile", "b.raw");
    expect_refused(ErrorKind::corrupt_file, "b.raw");
    for (const char* its_name : {"a.mha", "a.mhd"}) {
        file = its_name;
        for (const char* name : {"/etc/passwd", "../a.raw", "sub/a.raw", "..", "."}) {
            set("ElementDataFile", name);
            expect_refused(ErrorKind::unsupported, "plain file name");
        }
    }
    set("ElementDataFile", "missing.raw");
    expect_refused(ErrorKind::io, "missing.raw");
    for (const char* name : {"LIST", "slice%03d.raw 1 10 1"}) {
        set("ElementDataFile", name);
        expect_refused(ErrorKind::unsupported, "several files");
    }
}

}  // namespace
}  // namespace kontur
