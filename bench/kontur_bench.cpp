// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>

#include "experiments.h"
#include "growth.h"
#include "machine.h"

namespace kontur::bench {
namespace {

struct Options {
    bool quick = false;
    int repeat = 5;
    bool growth = false;
    std::size_t most = 1000000;
    std::string only;  ///< an experiment's name; empty: all
    std::string json = "/dev/stdout";
};

struct Experiment {
    const char* name;
    Json (*run)(const PhantomCase& phantom, int repeat);
    bool by_hand;  ///< also on the cases drawn by hand
};
constexpr Experiment kExperiments[] = {{"end_to_end", end_to_end, true}, {"editing", editing, true},
                                       {"deriving", deriving, false},    {"correcting", correcting, false},
                                       {"solving", solving, false},      {"voxelizing", voxelizing, true},
                                       {"reduction", reduction, true}};

/// Every eighth point of each contour.
PhantomCase thinned(PhantomCase phantom) {
    for (Contour& contour : phantom.contours.contours) {
        std::vector<Vec3> kept;
        for (std::size_t i = 0; i < contour.points.size(); i += 8) kept.push_back(contour.points[i]);
        contour.points = std::move(kept);
    }
    return phantom;
}

std::vector<PhantomCase> cases(bool quick) {
    if (quick) return {thinned(phantom_case("metastasis_parallel17"))};
    return {phantom_case("metastasis_parallel17"), phantom_case("metastasis_parallel17_hand"),
            phantom_case("liver_orthogonal14"), phantom_case("liver_orthogonal14_hand")};
}

Json run(const Options& options) {
    Json results{{"machine", describe_machine()}, {"quick", options.quick}};
    const std::vector<PhantomCase> all = cases(options.quick);
    for (const Experiment& experiment : kExperiments) {
        if (!options.only.empty() && options.only != experiment.name) continue;
        Json& rows = results[experiment.name] = Json::array();
        for (const PhantomCase& phantom : all) {
            if (phantom.name.ends_with("_hand") && !experiment.by_hand) continue;
            fmt::print(stderr, "kontur_bench: {} of {}\n", experiment.name, phantom.name);
            for (Json& row : experiment.run(phantom, options.repeat)) rows.push_back(std::move(row));
        }
    }
    return results;
}

Json run_growth(const Options& options) {
    return {{"machine", describe_machine()}, {"growth", growth(options.most, options.repeat)}};
}

void write(const Json& results, const std::string& path) {
    std::ofstream out(path);
    out << results.dump(2) << '\n';
    if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

}  // namespace
}  // namespace kontur::bench

int main(int count, char** arguments) {
    using namespace kontur::bench;
    Options options;
    CLI::App app("Times kontur on the cases of Heckel, Konrad & Peitgen 2010 and prints JSON; takes some minutes");
    app.add_flag("--quick", options.quick, "a small case and one run each, to see that it works");
    app.add_option("--repeat", options.repeat, "runs of which the median is taken")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_flag("--growth", options.growth,
                 "instead, how time and memory to solve grow from 1,000 to a million constraints; some minutes, 3 GB");
    app.add_option("--most", options.most, "with --growth, the largest system")->capture_default_str();
    std::vector<std::string> names;
    for (const Experiment& experiment : kExperiments) names.emplace_back(experiment.name);
    app.add_option("--only", options.only, "one experiment")->check(CLI::IsMember(names));
    app.add_option("--json", options.json, "file to write to instead of standard output");
    CLI11_PARSE(app, count, arguments);
    if (options.quick) options.repeat = 1;
    restart_with_fitting_blas(arguments);
    try {
        write(options.growth ? run_growth(options) : run(options), options.json);
    } catch (const std::exception& error) {
        fmt::print(stderr, "kontur_bench: {}\n", error.what());
        return 1;
    }
}
