// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/temporary_files.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "support/temporary_folder.h"

namespace kontur::viewer {
namespace {

/// The folder for temporary files, as long as it lives.
class TemporaryPlace {
public:
    TemporaryPlace() { setenv("TMPDIR", folder_.path().c_str(), 1); }
    ~TemporaryPlace() { before_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", before_.c_str(), 1); }
    TemporaryPlace(const TemporaryPlace&) = delete;
    TemporaryPlace& operator=(const TemporaryPlace&) = delete;
    const std::filesystem::path& path() const { return folder_.path(); }

private:
    const std::string before_ = getenv("TMPDIR") ? getenv("TMPDIR") : "";
    const kontur::test::TemporaryFolder folder_;
};

TEST(TemporaryFolder, OfAKilledProcessIsRemovedLaterAndNoOther) {
    const TemporaryPlace place;
    const pid_t child = fork();
    if (child == 0) {
        const TemporaryFolder left;
        std::ofstream(left.path() / "upload.json") << "{}";
        _exit(0);
    }
    waitpid(child, nullptr, 0);
    const TemporaryFolder ours;
    std::filesystem::create_directory(place.path() / "kontur-abcdef");
    std::filesystem::create_directory(place.path() / "other");
    const auto entries = [&] { return std::distance(std::filesystem::directory_iterator(place.path()), {}); };
    EXPECT_EQ(entries(), 4);
    remove_left_folders();
    EXPECT_EQ(entries(), 3);
    EXPECT_TRUE(std::filesystem::exists(ours.path()));
    EXPECT_TRUE(std::filesystem::exists(place.path() / "kontur-abcdef")) << "whose it is cannot be known";
}

}  // namespace
}  // namespace kontur::viewer
