// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <string_view>

namespace kontur::test {

inline std::string read_bytes(const std::filesystem::path& path) {
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    return bytes.str();
}

inline void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Calls `visit` with every `step`-th proper prefix of the bytes.
template <typename Visit>
void for_each_prefix(const std::string& bytes, std::size_t step, const Visit& visit) {
    for (std::size_t length = 0; length < bytes.size(); length += step) visit(bytes.substr(0, length));
}

/// Calls `visit` with `count` copies of the bytes of which one to four were overwritten at random; the seed makes it
/// repeatable.
template <typename Visit>
void for_each_mutant(const std::string& bytes, int count, std::uint32_t seed, const Visit& visit) {
    std::mt19937 random(seed);
    for (int n = 0; n < count; ++n) {
        std::string mutant = bytes;
        for (auto left = 1 + random() % 4; left > 0; --left) mutant[random() % mutant.size()] = static_cast<char>(random());
        visit(mutant);
    }
}

}  // namespace kontur::test
