// SPDX-License-Identifier: Apache-2.0
// Simulated annotators draw bodies whose truth is known, plane by plane, in several ways:
// docs/accuracy/sureness.md. A line of JSON for each state.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "kontur/base/error.h"
#include "ways.h"

namespace {

struct Words {
    std::vector<std::filesystem::path> folders;
    std::vector<std::string> ways;
    bool by_hand = false, with_image = false;
    std::size_t sample_step = 0;
    kontur::WayLimits limits;
};

void run(const Words& words) {
    kontur::WayLimits limits = words.limits;
    if (words.with_image) limits.use_image = kontur::UseImage::automatic;
    for (const std::filesystem::path& folder : words.folders) {
        const kontur::Truth truth(folder, words.by_hand ? kontur::Truth::Hand::unsteady : kontur::Truth::Hand::exact);
        for (const std::string& way : words.ways) {
            kontur::ways().at(way)(truth, limits, [&](const kontur::Annotator& annotator) {
                nlohmann::ordered_json line{{"structure", truth.name()},
                                            {"way", words.with_image ? way + ", image" : way},
                                            {"hand", words.by_hand ? "unsteady" : "exact"}};
                line.update(annotator.facts(words.sample_step));
                fmt::print("{}\n", line.dump());
                std::fflush(stdout);
            });
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    Words words;
    CLI::App app("Simulated annotators: a line of JSON for each plane drawn");
    app.add_option("FOLDERS", words.folders, "What truths.py wrote, one for each structure")->required();
    app.add_option("--way", words.ways, "How planes are chosen; again for more [all]")->allow_extra_args(false);
    app.add_flag("--by-hand", words.by_hand, "Contours waver by 0.55 mm");
    app.add_flag("--with-image", words.with_image, "The image is asked between the contours, where there is one");
    app.add_option("--sample-step", words.sample_step, "Every so many samples of the surface, with their errors; 0: none");
    app.add_option("--most-planes", words.limits.most_planes, "Planes after which an annotator gives up")
        ->check(CLI::Range(1, 15))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    if (words.ways.empty())
        for (const auto& [name, way] : kontur::ways()) words.ways.push_back(name);
    try {
        run(words);
    } catch (const std::exception& error) {
        fmt::print(stderr, "kontur_annotators: {}\n", error.what());
        return 1;
    }
}
