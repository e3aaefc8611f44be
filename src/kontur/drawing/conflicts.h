// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur {

/// What happens where contours of different planes contradict each other.
enum class Conflicts {
    reconcile,    ///< both yield
    newest_wins,  ///< the one that comes first in the set yields
    exact,        ///< neither yields; where they contradict each other the surface may bulge
};
std::string_view name(Conflicts conflicts) noexcept;

}  // namespace kontur
