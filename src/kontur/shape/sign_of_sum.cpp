// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/sign_of_sum.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace kontur {
namespace {

constexpr int kWord = 64;

/// A double without its sign: `significand` times 2 to the power of `exponent`.
struct Magnitude {
    std::uint64_t significand;
    int exponent;
};

Magnitude magnitude(double value) {
    constexpr int kFraction = 52, kBias = 1023 + kFraction;
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const auto fraction = bits & ((std::uint64_t{1} << kFraction) - 1);
    const int exponent = static_cast<int>(bits >> kFraction & 0x7FF);
    if (exponent == 0) return {fraction, 1 - kBias};  // zero and subnormal numbers
    return {fraction | std::uint64_t{1} << kFraction, exponent - kBias};
}

/// An integer below 2^128 times 2 to the power of `exponent`, with a sign.
struct Term {
    std::uint64_t low, high;
    int exponent;
    bool is_negative;
};

/// By halves of 32 bits; significands have 53, so that no part overflows.
Term exact(const Product& product) {
    constexpr std::uint64_t kHalf = 0xFFFFFFFF;
    const Magnitude x = magnitude(product.x), y = magnitude(product.y);
    const std::uint64_t x_low = x.significand & kHalf, x_high = x.significand >> 32;
    const std::uint64_t y_low = y.significand & kHalf, y_high = y.significand >> 32;
    const std::uint64_t lowest = x_low * y_low, middle = x_high * y_low + x_low * y_high;
    const std::uint64_t low = lowest + (middle << 32);
    const std::uint64_t carry = low < lowest ? 1 : 0;
    const auto is_below_zero = [](double value) { return std::bit_cast<std::int64_t>(value) < 0; };
    return {low, x_high * y_high + (middle >> 32) + carry, x.exponent + y.exponent,
            is_below_zero(product.x) != is_below_zero(product.y)};
}

/// A sum in two's complement, with as many words as the terms' exponents need.
class Sum {
public:
    Sum(int lowest_exponent, int highest_exponent)
        : lowest_(lowest_exponent),
          size_(static_cast<std::size_t>((highest_exponent - lowest_exponent) / kWord + kWordsOfTerm + 1)) {
        std::fill_n(words_.begin(), size_, 0);
    }

    void add(const Term& term) {
        const int shift = term.exponent - lowest_, bit = shift % kWord;
        std::array<std::uint64_t, kWordsOfTerm> parts{term.low << bit, term.high << bit, 0};
        if (bit > 0) {
            parts[1] |= term.low >> (kWord - bit);
            parts[2] = term.high >> (kWord - bit);
        }
        // A negative term is added as its complement and one.
        const std::uint64_t flipped = term.is_negative ? ~std::uint64_t{0} : 0;
        std::uint64_t carry = flipped & 1;
        const auto first = static_cast<std::size_t>(shift / kWord);
        for (std::size_t i = first; i < size_; ++i) {
            const std::uint64_t part = (i - first < kWordsOfTerm ? parts[i - first] : 0) ^ flipped;
            const std::uint64_t with_carry = part + carry;
            words_[i] += with_carry;
            carry = (with_carry < part || words_[i] < with_carry) ? 1 : 0;
        }
    }

    int sign() const {
        if (words_[size_ - 1] >> (kWord - 1)) return -1;
        return std::all_of(words_.begin(), words_.begin() + size_, [](std::uint64_t word) { return word == 0; }) ? 0 : 1;
    }

private:
    static constexpr std::size_t kWordsOfTerm = 3;
    /// Exponents of products of doubles.
    static constexpr int kLowest = 2 * -1074, kHighest = 2 * (1023 - 52);
    static constexpr std::size_t kMostWords = (kHighest - kLowest) / kWord + kWordsOfTerm + 1;

    int lowest_;
    std::size_t size_;
    std::array<std::uint64_t, kMostWords> words_;
};

}  // namespace

int sign_of_sum(const std::array<Product, 6>& products) {
    std::array<Term, 6> terms;
    std::size_t count = 0;
    for (const Product& product : products)
        if (const Term term = exact(product); (term.low | term.high) != 0) terms[count++] = term;
    if (count == 0) return 0;
    const auto end = terms.begin() + static_cast<std::ptrdiff_t>(count);
    const auto [lowest, highest] =
        std::minmax_element(terms.begin(), end, [](const Term& a, const Term& b) { return a.exponent < b.exponent; });
    Sum sum(lowest->exponent, highest->exponent);
    std::for_each(terms.begin(), end, [&](const Term& term) { sum.add(term); });
    return sum.sign();
}

}  // namespace kontur
