// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "kontur/measure/section_check.h"

namespace kontur {

enum class SectionFaultKind {
    missing,  ///< in a plane: drawn, and not in the result
    surplus,  ///< in a plane: in the result, and not drawn
    island,   ///< the same, apart from all that is drawn there
    between,  ///< missing between two planes
    beyond,   ///< too much beyond a last plane
    outside,  ///< far outside of all that was drawn
};
std::string_view name(SectionFaultKind kind) noexcept;

/// A place to look at.
struct SectionFault {
    SectionFaultKind kind;
    Vec3 position;                        ///< mm
    std::vector<std::size_t> contours{};  ///< indices of the first ones drawn in its planes; none of an empty plane, outside
    double share = 0;                     ///< of the section, of the ways between, of the object; 0 of `beyond`
    double length_mm = 0;                 ///< between the two planes, or beyond the last one; else 0
};

/// What is wrong, one place for each plane and each pair of planes, in the order of the kinds' checks, largest first.
std::vector<SectionFault> faults(const SectionCheck& check);

}  // namespace kontur
