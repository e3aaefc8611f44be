// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "commands.h"
#include "describe.h"
#include "kontur/base/error.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

Facts inspect_image(const InspectCommand& command, const fs::path& path, Console& console) {
    const LoadedImage loaded = load_image({path, command.read, {}}, console.progress());
    Facts facts = {{"kind", "image"}};
    facts.update(describe(loaded.image));
    facts["notes"] = loaded.notes;
    return facts;
}

Facts inspect_contours(const fs::path& path) {
    Facts facts = {{"kind", "contours"}};
    facts.update(describe(load_contours({&path, 1}, std::nullopt).contours));
    return facts;
}

Facts inspect(const InspectCommand& command, const fs::path& path, Console& console) {
    switch (input_kind(path)) {
        case FileKind::image:
            return inspect_image(command, path, console);
        case FileKind::contours:
            return inspect_contours(path);
        case FileKind::mesh:
            break;
    }
    throw Error(ErrorKind::unsupported, "meshes cannot be inspected");
}

}  // namespace

void run(const InspectCommand& command, Console& console) {
    Facts all = Facts::array();
    std::optional<Error> first_error;
    for (const fs::path& path : command.files) {
        Facts facts = {{"file", path.string()}};
        try {
            facts.update(inspect(command, path, console));
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            facts["error"] = error.what();
            if (!first_error) first_error = error;
        }
        if (!command.json) console.print(facts.value("file", "") + "\n" + to_text(facts));
        all.push_back(std::move(facts));
    }
    if (command.json) console.print(all.dump(2) + "\n");
    if (first_error) throw *first_error;
}

}  // namespace kontur::app
