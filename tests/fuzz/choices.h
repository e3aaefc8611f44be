// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "fuzz/targets.h"

namespace kontur::fuzz {

/// Turns bytes into choices, one after the other; zeros when they are used up. So a mutation of a byte changes one choice.
class Choices {
public:
    explicit Choices(Bytes bytes) : bytes_(bytes) {}

    bool left() const { return at_ < bytes_.size(); }
    int byte() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }
    /// 0 to count - 1.
    int below(int count) { return byte() % count; }
    bool flag() { return byte() & 1; }
    /// From low to high in 65536 steps.
    double between(double low, double high) {
        const int high_byte = byte();
        return low + (high - low) * (256 * high_byte + byte()) / 65535;
    }

private:
    Bytes bytes_;
    std::size_t at_ = 0;
};

}  // namespace kontur::fuzz
