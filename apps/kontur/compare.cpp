// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <string>

#include "commands.h"
#include "facts.h"
#include "kontur/base/error.h"

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

/// As many as there are up to `most`.
Facts list_of(const std::vector<Difference>& differences, int most) {
    Facts list = Facts::array();
    for (const Difference& one : differences) {
        if (std::ssize(list) == most) break;
        list.push_back({{"only_in", one.in_first ? "a" : "b"},
                        {"distance_mm", one.distance_mm},
                        {"volume_ml", one.volume_ml},
                        {"at_mm", {number(one.at.x), number(one.at.y), number(one.at.z)}}});
    }
    return list;
}

struct Side {
    Mask mask;
    std::optional<std::int64_t> label;  ///< of its file; unset: the mask is empty
};

Side read_side(const std::filesystem::path& path, const std::optional<std::int64_t>& label, const ReadImageOptions& read,
               const Work& work) {
    if (label) return {read_mask(path, label, read, work), label};
    try {
        const Image image = read_label_image(path, read, work);
        if (const auto labels = count_labels(image, 1); !labels.empty())
            return {select_nonzero(image), labels.begin()->first};
    } catch (const Error&) {  // several labels, layers or none, which read_mask refuses with their list
    }
    return {read_mask(path, {}, read, work), {}};
}

Facts label_of(const Side& side) { return side.label ? Facts(*side.label) : Facts(nullptr); }

}  // namespace

void run(const CompareCommand& command, Console& console) {
    const Work work = console.work(command.threads);
    const ReadImageOptions read = console.noting(command.read);
    ReadImageOptions read_b = read;
    if (command.frame_b) read_b.frame = command.frame_b;
    const Side a = read_side(command.a, command.label, read, work);
    const Side b = read_side(command.b, command.label_b ? command.label_b : command.label, read_b, work);
    if (a.label && b.label && a.label != b.label)
        console.note(std::array{fmt::format("label {} of {} is compared with label {} of {}", *a.label, command.a.string(),
                                            *b.label, command.b.string())});
    Facts facts = {{"label_a", label_of(a)}, {"label_b", label_of(b)}};
    facts.update(describe(compare(a.mask, b.mask, work)));
    if (command.differences > 0)
        facts["differences"] = list_of(differences(a.mask, b.mask, kSaddle, work), command.differences);
    console.print(command.json ? to_json_text(facts) : to_text(facts));
}

}  // namespace kontur::app
