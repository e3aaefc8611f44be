// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/structure_pair.h"

namespace kontur {

std::string_view name(Relation relation) noexcept {
    switch (relation) {
        case Relation::exclusive:
            return "exclusive";
        case Relation::inside:
            return "inside";
        case Relation::overlap:
            return "overlap";
    }
    return "?";
}

}  // namespace kontur
