// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "kontur/base/error.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

std::string io_error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::io);
        return error.what();
    }
    ADD_FAILURE() << "no Error";
    return {};
}

/// Files may not grow beyond `bytes` while this lives: the same short write and errno path as a full disk.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    void (*handler_)(int);
    rlimit before_{};
};

TEST(AtomicFile, WritesSmallAndLargePiecesInOrder) {
    const test::TemporaryFolder folder;
    std::string expected;
    write_file_atomically(folder / "a.bin", [&](AtomicFile& file) {
        for (std::size_t size : {1u, 7u, 1000u, 262143u, 262144u, 262145u, 3u, 1000000u, 5u}) {
            const std::string piece(size, static_cast<char>('a' + size % 26));
            file.write(piece);
            expected += piece;
        }
    });
    EXPECT_EQ(content_of(folder / "a.bin"), expected);
    EXPECT_EQ(folder.entry_count(), 1);
}

TEST(AtomicFile, AKilledWriterLeavesNothing) {
    const test::TemporaryFolder folder;
    write_file_atomically(folder / "old.txt", "whole");
    const int trial = ::open(folder.path().c_str(), O_WRONLY | O_TMPFILE);
    if (trial < 0) GTEST_SKIP() << "this file system has no files without a name";
    ::close(trial);
    const ::pid_t child = ::fork();
    if (child == 0) {
        AtomicFile file(folder / "old.txt");
        file.write(std::string(1000000, 'x'));
        ::raise(SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    EXPECT_EQ(content_of(folder / "old.txt"), "whole");
    EXPECT_EQ(folder.entry_count(), 1);
}

TEST(AtomicFile, GivesLibrariesAPathWithTheTargetsExtension) {
    const test::TemporaryFolder folder;
    write_file_atomically(folder / "a.dcm", [&](AtomicFile& file) {
        EXPECT_EQ(file.temporary_path().extension(), ".dcm");
        EXPECT_EQ(file.temporary_path(), file.temporary_path());
        std::ofstream(file.temporary_path(), std::ios::binary) << "by a library";
    });
    EXPECT_EQ(content_of(folder / "a.dcm"), "by a library");
    EXPECT_EQ(folder.entry_count(), 1);
}

TEST(AtomicFile, ExceptionLeavesNothingAndKeepsTheOldFile) {
    const test::TemporaryFolder folder;
    const auto interrupted = [](AtomicFile& file) {
        file.write("half");
        throw std::runtime_error("interrupted");
    };
    EXPECT_THROW(write_file_atomically(folder / "new.txt", interrupted), std::runtime_error);
    EXPECT_EQ(folder.entry_count(), 0);
    write_file_atomically(folder / "old.txt", "whole");
    EXPECT_THROW(write_file_atomically(folder / "old.txt", interrupted), std::runtime_error);
    EXPECT_EQ(content_of(folder / "old.txt"), "whole");
    EXPECT_EQ(folder.entry_count(), 1);
}

TEST(AtomicFile, ShortWriteLeavesNothingAndKeepsTheOldFile) {
    const test::TemporaryFolder folder;
    write_file_atomically(folder / "old.bin", "whole");
    for (const std::size_t size : {5000u, 1000000u})
        for (const char* name : {"new.bin", "old.bin"}) {
            const std::string message = [&] {
                const FileSizeLimit limit(4096);
                return io_error_of([&] { write_file_atomically(folder / name, std::string(size, 'x')); });
            }();
            EXPECT_NE(message.find(name), std::string::npos) << message;
            EXPECT_NE(message.find("File too large"), std::string::npos) << message;
        }
    EXPECT_EQ(content_of(folder / "old.bin"), "whole");
    EXPECT_EQ(folder.entry_count(), 1);
}

TEST(AtomicFile, FullDiskLeavesNothingAndKeepsTheOldFile) {
    const test::TemporaryFolder folder;
    if (::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0)
        GTEST_SKIP() << "mounting a small file system needs root";
    write_file_atomically(folder / "old.bin", "whole");
    const std::string message = io_error_of([&] { write_file_atomically(folder / "old.bin", std::string(1000000, 'x')); });
    EXPECT_NE(message.find("No space left on device"), std::string::npos) << message;
    EXPECT_EQ(content_of(folder / "old.bin"), "whole");
    EXPECT_EQ(folder.entry_count(), 1);
    EXPECT_EQ(::umount(folder.path().c_str()), 0);
}

TEST(AtomicFile, KeepsPermissionsAndFollowsLinks) {
    const test::TemporaryFolder folder;
    write_file_atomically(folder / "real.txt", "old");
    ::chmod((folder / "real.txt").c_str(), 0640);
    fs::create_symlink("real.txt", folder / "link.txt");
    write_file_atomically(folder / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(content_of(folder / "real.txt"), "new");
    EXPECT_EQ(static_cast<int>(fs::status(folder / "real.txt").permissions()), 0640);
}

TEST(AtomicFile, FollowsLinksToWhereNothingIsYet) {
    const test::TemporaryFolder folder;
    fs::create_directory(folder / "far");
    fs::create_symlink("far/second.txt", folder / "first.txt");
    fs::create_symlink(fs::absolute(folder / "real.txt"), folder / "far/second.txt");
    write_file_atomically(folder / "first.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "first.txt"));
    EXPECT_TRUE(fs::is_symlink(folder / "far/second.txt"));
    EXPECT_EQ(content_of(folder / "real.txt"), "new");
}

TEST(AtomicFile, RefusesLinksInACircle) {
    const test::TemporaryFolder folder;
    fs::create_symlink("b.txt", folder / "a.txt");
    fs::create_symlink("a.txt", folder / "b.txt");
    const std::string message = io_error_of([&] { write_file_atomically(folder / "a.txt", "new"); });
    EXPECT_NE(message.find("a.txt: Too many levels of symbolic links"), std::string::npos) << message;
    EXPECT_TRUE(fs::is_symlink(folder / "a.txt"));
}

TEST(AtomicFile, AcceptsTheLongestName) {
    const test::TemporaryFolder folder;
    const fs::path path = folder / std::string(251, 'n').append(".txt");
    write_file_atomically(path, "x");
    EXPECT_EQ(content_of(path), "x");
}

TEST(AtomicFile, NamesTargetAndReasonWhenItCannotOpen) {
    const test::TemporaryFolder folder;
    const std::string missing = io_error_of([&] { write_file_atomically(folder / "no/such/a.txt", "x"); });
    EXPECT_NE(missing.find("no/such/a.txt: No such file or directory"), std::string::npos) << missing;
    EXPECT_NE(io_error_of([&] { write_file_atomically(folder.path(), "x"); }).find("folder"), std::string::npos);
    EXPECT_NE(io_error_of([&] { write_file_atomically("/dev/null", "x"); }).find("regular"), std::string::npos);
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, LibraryMayWriteThroughTheTemporaryPath) {
    const test::TemporaryFolder folder;
    write_file_atomically(folder / "a.png", [&](AtomicFile& file) {
        EXPECT_EQ(file.temporary_path().extension(), ".png");
        EXPECT_EQ(file.temporary_path().parent_path(), folder.path());
        std::ofstream(file.temporary_path()) << "picture";
    });
    EXPECT_EQ(content_of(folder / "a.png"), "picture");
    EXPECT_EQ(folder.entry_count(), 1);
}

}  // namespace
}  // namespace kontur
