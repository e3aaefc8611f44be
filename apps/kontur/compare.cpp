// SPDX-License-Identifier: Apache-2.0
#include "commands.h"
#include "facts.h"

namespace kontur::app {
namespace {

Facts describe(const Comparison& comparison) {
    Facts facts = {
        {"dice", comparison.dice},
        {"jaccard", comparison.jaccard},
        {"hausdorff_mm", nullptr},
        {"hausdorff95_mm", nullptr},
        {"mean_surface_distance_mm", nullptr},
        {"volume_a_ml", comparison.volume_a_ml},
        {"volume_b_ml", comparison.volume_b_ml},
    };
    if (comparison.surface) {
        facts["hausdorff_mm"] = comparison.surface->hausdorff_mm;
        facts["hausdorff95_mm"] = comparison.surface->hausdorff95_mm;
        facts["mean_surface_distance_mm"] = comparison.surface->mean_surface_distance_mm;
    }
    return facts;
}

}  // namespace

void run(const CompareCommand& command, Console& console) {
    const Progress progress = console.progress();
    const ReadImageOptions read = console.noting(command.read);
    const Mask a = read_mask(command.a, command.label, read, progress);
    const Mask b = read_mask(command.b, command.label, read, progress);
    const Facts facts = describe(compare(a, b, command.options, progress));
    console.print(command.json ? to_json_text(facts) : to_text(facts));
}

}  // namespace kontur::app
