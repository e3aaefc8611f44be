// SPDX-License-Identifier: Apache-2.0
#include "archive/fetch.h"

#include <fmt/format.h>

#include "archive/query.h"
#include "commands.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;
using archive::Address;

void fetch_one(archive::Http& http, const Address& series, const fs::path& folder, Console& console) {
    const std::size_t objects = archive::fetch_into_folder(
        http, series, folder, console.work(),
        [](const std::string& how_far) { throw EndedEarly("interrupted; " + how_far, exit_code(ErrorKind::cancelled)); });
    console.print(fmt::format("{}: {}\n", folder.string(), counted(objects, "object")));
}

/// Each series into a folder of its own.
void fetch_study(archive::Http& http, const Address& study, const FetchCommand& command, Console& console) {
    for (const archive::Series& one : archive::find_series_of(http, study, command.modality, console.work()))
        fetch_one(http, {study.service, study.study_uid, one.uid, ""}, command.output / one.uid, console);
}

}  // namespace

void run(const FetchCommand& command, Console& console) {
    const Address address = archive::parse_address(command.address);
    archive::check_names_study(address);
    if (!command.modality.empty() && !address.series_uid.empty())
        throw Error(ErrorKind::invalid_input, "--modality chooses series of a study; the address names one already");
    archive::Http http(address, access_of(command.access));
    if (!address.instance_uid.empty()) {
        archive::fetch_instance(http, address, command.output, console.work());
        return console.print(command.output.string() + "\n");
    }
    if (address.series_uid.empty()) fetch_study(http, address, command, console);
    else fetch_one(http, address, command.output, console);
}

}  // namespace kontur::app
