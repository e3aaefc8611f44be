// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/phantom.h"

#include <fmt/format.h>

#include <algorithm>

#include "commands.h"
#include "facts.h"
#include "input_digests.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/contours.h"
#include "kontur/io/image.h"
#include "kontur/phantom/cases.h"
#include "kontur/phantom/volumes.h"
#include "outputs.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

std::vector<PhantomVolume> chosen_volumes(const std::vector<std::string>& names) {
    std::vector<PhantomVolume> all = phantom_volumes();
    if (names.empty()) return all;
    std::vector<PhantomVolume> chosen;
    for (const std::string& name : names) {
        const auto found = std::find_if(all.begin(), all.end(), [&](const PhantomVolume& v) { return v.name == name; });
        if (found != all.end()) {
            chosen.push_back(*found);
            continue;
        }
        std::string known;
        for (const PhantomVolume& volume : all) known += (known.empty() ? "" : ", ") + volume.name;
        throw Error(ErrorKind::invalid_input, fmt::format("the phantom has no scan '{}'; it has {}", name, known));
    }
    return chosen;
}

/// Writes the phantom's files into one folder and keeps the list of what they are.
class Writer {
public:
    Writer(const PhantomCommand& command, Console& console) : command_(command), console_(console) {}

    void write_volume(const PhantomVolume& volume, Outputs& outputs) {
        const Work work = console_.work(command_.threads);
        const std::string ct = volume.name + "_ct.nii.gz";
        outputs.write(command_.folder / ct, [&](const fs::path& path) {
            write_image(path, make_phantom_image(volume.grid, command_.options, work), {}, made_);
        });
        Facts truths = Facts::object();
        for (const Body& body : volume.bodies) {
            work.check();
            const std::string mask = fmt::format("{}_truth_{}.nii.gz", volume.name, body.name());
            outputs.write(command_.folder / mask, [&](const fs::path& path) {
                write_mask(path, make_truth_mask(body, volume.grid, work), {}, made_);
            });
            truths[body.name()] = mask;
        }
        list_["volumes"].push_back({{"image", ct}, {"note", volume.note}, {"truth", truths}});
    }

    void write_case(const std::string& name, Outputs& outputs) {
        console_.work().check();
        const PhantomCase found = phantom_case(name);
        const std::string file = name + ".json";
        outputs.write(command_.folder / file, [&](const fs::path& path) { write_contours(path, found.contours, made_); });
        list_["contours"].push_back({{"file", file},
                                     {"note", found.note},
                                     {"body", found.body ? Facts(found.body->name()) : Facts(nullptr)},
                                     {"contours", found.contours.contours.size()},
                                     {"points", point_count(found.contours)}});
    }

    void write_list(Outputs& outputs) {
        outputs.write(command_.folder / "phantom.json",
                      [&](const fs::path& path) { write_file_atomically(path, to_json_text(list_)); });
    }

    std::string summary() const {
        std::string text;
        for (const Facts& volume : list_["volumes"])
            text += fmt::format("{}: {}\n", volume["image"].get<std::string>(), volume["note"].get<std::string>());
        for (const Facts& set : list_["contours"])
            text += fmt::format("{}: {}\n", set["file"].get<std::string>(), set["note"].get<std::string>());
        return text;
    }

private:
    const PhantomCommand& command_;
    Console& console_;
    Provenance made_ =
        made_by("phantom", {}, fmt::format("seed={} noise_hu={}", command_.options.seed, command_.options.noise_hu), {});
    Facts list_ = {{"volumes", Facts::array()}, {"contours", Facts::array()}};
};

}  // namespace

void run(const PhantomCommand& command, Console& console) {
    const std::vector<PhantomVolume> volumes = chosen_volumes(command.scans);
    Outputs outputs;
    outputs.create_folder(command.folder);
    Writer writer(command, console);
    for (const PhantomVolume& volume : volumes) writer.write_volume(volume, outputs);
    for (const std::string& name : phantom_case_names()) writer.write_case(name, outputs);
    writer.write_list(outputs);
    outputs.commit();
    console.print(writer.summary() +
                  fmt::format("all in {}; phantom.json there says what belongs together\n", command.folder.string()));
}

}  // namespace kontur::app
