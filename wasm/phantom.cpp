// SPDX-License-Identifier: Apache-2.0
// The phantom that kontur generates, for trying things without data of one's own.
#include "kontur/phantom/phantom.h"

#include <memory>
#include <utility>

#include "kontur/io/contours/contour_json.h"
#include "kontur/phantom/cases.h"
#include "requests.h"
#include "result.h"
#include "samples.h"

using namespace kontur;
using namespace kontur::wasm;

/// Contours and grid of a case.
KONTUR_EXPORT(kontur_phantom)(const char* name, std::size_t length)->Result* {
    return or_error([&] {
        const PhantomCase chosen = phantom_case({name, length});
        auto result = std::make_unique<Result>();
        result->about = {{"contours", nlohmann::json::parse(to_contour_json(chosen.contours))},
                         {"grid", to_json(chosen.grid)}};
        return result.release();
    });
}

/// The voxels of the grid in a case's body.
KONTUR_EXPORT(kontur_phantom_truth)
(const char* name, std::size_t length, const char* grid, std::size_t grid_length)->Result* {
    return or_error([&] {
        const PhantomCase chosen = phantom_case({name, length});
        if (!chosen.body) throw Error(ErrorKind::invalid_input, chosen.name + " has no body");
        auto result = std::make_unique<Result>();
        result->voxels = make_truth_mask(*chosen.body, grid_from({grid, grid_length}), {.threads = 1}).values;
        return result.release();
    });
}

/// Its CT on a grid, as an Int16Array.
KONTUR_EXPORT(kontur_phantom_image)(const char* grid, std::size_t length)->Result* {
    return or_error([&] {
        auto result = std::make_unique<Result>();
        result->voxels = bytes_of(make_phantom_image(grid_from({grid, length}), {}, told_work()));
        return result.release();
    });
}
