// SPDX-License-Identifier: Apache-2.0
// What fuzzing found once must never come back, and each target must live through some thousand mutations of sound input
// wherever the suite runs. No fuzzer is needed for it: `make torture` runs the same targets under libFuzzer.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "fuzz/targets.h"
#include "support/damage.h"
#include "support/random.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"

namespace kontur::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    if (fs::exists(folder))
        for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

Bytes bytes_of(const std::string& text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

void run_file(const Target& target, const fs::path& path) {
    SCOPED_TRACE(path.string());
    const std::string content = test::read_bytes(path);
    run(target, bytes_of(content));
}

class Fuzz : public testing::TestWithParam<Target> {};

TEST_P(Fuzz, FindingsStayFixed) {
    for (const fs::path& path : files_in(fs::path(KONTUR_FUZZ_REGRESSIONS) / GetParam().name)) run_file(GetParam(), path);
}

/// Half a second, or KONTUR_FUZZ_SECONDS.
std::chrono::duration<double> time_to_spend() {
    const char* seconds = std::getenv("KONTUR_FUZZ_SECONDS");
    return std::chrono::duration<double>(seconds ? std::atof(seconds) : 0.5);
}

/// Bytes overwritten, removed, repeated.
TEST_P(Fuzz, SurvivesMutationsOfSoundInput) {
    const test::TemporaryFolder folder;
    const auto made = test::run_python("../fuzz/make_seeds.py", {std::string(GetParam().name), folder.path().string()});
    ASSERT_EQ(made.exit_code, 0) << made.output;
    const std::vector<fs::path> seeds = files_in(folder.path());
    ASSERT_FALSE(seeds.empty());
    std::mt19937 random = test::random_of_this_test();
    std::vector<std::string> sound;
    for (const fs::path& seed : seeds) sound.push_back(test::read_bytes(seed));
    for (const std::string& content : sound) run(GetParam(), bytes_of(content));
    const auto end = std::chrono::steady_clock::now() + time_to_spend();
    std::int64_t runs = 0;
    for (; std::chrono::steady_clock::now() < end; ++runs) {
        std::string mutant = sound[random() % sound.size()];
        for (auto left = 1 + random() % 4; left > 0 && !mutant.empty(); --left) {
            const std::size_t at = random() % mutant.size(), count = 1 + random() % 16;
            const auto kind = random() % 8;
            if (kind == 0) mutant.erase(at, count);
            else if (kind == 1) mutant.insert(at, mutant.substr(at, count));
            else if (kind == 2) mutant.resize(at);
            else if (kind == 3) mutant.replace(at, std::min<std::size_t>(4, mutant.size() - at), "\xff\xff\xff\xff");
            else mutant[at] = static_cast<char>(random());
        }
        run(GetParam(), bytes_of(mutant));
    }
    RecordProperty("runs", std::to_string(runs));
    std::printf("%lld mutations\n", static_cast<long long>(runs));
}

INSTANTIATE_TEST_SUITE_P(Targets, Fuzz, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace kontur::fuzz
