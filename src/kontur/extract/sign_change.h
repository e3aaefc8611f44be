// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to extract/: how crossings of lattice edges are drawn to the function's zero.

namespace kontur {

/// Two places between which a function changes its sign, and its values there. `At` says where: a fraction of an edge, or a
/// position.
template <class At>
struct SignChange {
    At low{}, high{};
    double low_value = 0, high_value = 0;
    int last_moved = 0;  ///< -1: low, 1: high

    /// Where between low (0) and high (1) the straight line through the two values is zero.
    double zero() const { return low_value / (low_value - high_value); }

    /// One step of regula falsi. When the same end moves twice the other one's value is halved (the Illinois algorithm,
    /// Dowell & Jarratt 1971), which draws both ends to the zero.
    void narrow(const At& at, double value) {
        const bool moves_low = (value > 0) == (low_value > 0);
        if (moves_low) {
            low = at, low_value = value;
            if (last_moved == -1) high_value /= 2;
        } else {
            high = at, high_value = value;
            if (last_moved == 1) low_value /= 2;
        }
        last_moved = moves_low ? -1 : 1;
    }
};

}  // namespace kontur
