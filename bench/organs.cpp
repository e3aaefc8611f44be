// SPDX-License-Identifier: Apache-2.0
#include "organs.h"

#include <string_view>

#include "agreement.h"
#include "kontur/phantom/cases.h"
#include "kontur/phantom/phantom.h"

namespace kontur {

std::vector<Organ> organs() {
    std::vector<Organ> all;
    for (const std::string_view name :
         {"liver_orthogonal14", "kidney_radial6", "metastasis_parallel17", "vertebra_parallel11"}) {
        const PhantomCase drawn = phantom_case(name);
        const Grid grid = drawn.body->name() == "liver" ? coarsened(drawn.grid) : drawn.grid;
        Organ organ{*drawn.body, make_truth_mask(*drawn.body, grid), {}};
        organ.box = bounding_box(organ.truth);
        all.push_back(organ);
    }
    return all;
}

}  // namespace kontur
