// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "kontur/kontur.h"

int main() {
    const kontur::PhantomCase kidney = kontur::phantom_case("kidney_radial6");
    std::cout << kontur::segment(kidney.contours, kidney.grid).report.mask_volume_ml << '\n';
    try {
        kontur::phantom_case("none");
    } catch (const kontur::Error& error) {
        std::cout << kontur::name(error.kind()) << '\n';
    }
}
