// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace kontur {

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014): a bijection of 64-bit integers whose output bits look
/// independent.
constexpr std::uint64_t mix_bits(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// A seed from a name (FNV-1a), so that every named case has random numbers of its own.
constexpr std::uint64_t seed_of(std::string_view name) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return hash;
}

/// Random numbers that are the same with every standard library, which <random>'s distributions are not.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(mix_bits(seed)) {}

    /// In (0, 1).
    double uniform() {
        state_ += 0x9e3779b97f4a7c15u;
        return (static_cast<double>(mix_bits(state_) >> 11) + 0.5) * 0x1p-53;
    }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Standard normal (Box & Muller 1958).
    double gaussian() {
        const double radius = std::sqrt(-2 * std::log(uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }

private:
    std::uint64_t state_;
};

}  // namespace kontur
