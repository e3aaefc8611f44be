// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/kernel.h"

namespace kontur {

std::string_view name(Kernel kernel) noexcept {
    switch (kernel) {
        case Kernel::screened:
            return "screened";
        case Kernel::triharmonic:
            return "triharmonic";
        case Kernel::biharmonic:
            return "biharmonic";
    }
    return "?";
}

}  // namespace kontur
