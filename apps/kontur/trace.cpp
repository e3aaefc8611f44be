// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "commands.h"
#include "kontur/io/contour_json.h"
#include "outputs.h"

namespace kontur::app {

void run(const TraceCommand& command, Console& console) {
    check_output(command.output, std::array{command.mask, command.planes});
    check_output_kind(command.output, FileKind::contours);
    const std::vector<Plane> planes = read_planes_json(command.planes);
    const Mask mask = read_mask(command.mask, command.label, command.read);
    const ContourSet set = trace(mask, planes, command.options, console.progress());
    if (set.contours.empty()) console.warn(fmt::format("none of the {} planes meets the mask", planes.size()));

    Outputs outputs;
    outputs.write(command.output, [&](const std::filesystem::path& path) { write_contours(path, set); });
    outputs.commit();
    console.print(fmt::format("{}: {} contours with {} points in {} planes\n", command.output.string(), set.contours.size(),
                              point_count(set), planes.size()));
}

}  // namespace kontur::app
