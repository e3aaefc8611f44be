// SPDX-License-Identifier: Apache-2.0
#include "archive/send.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;
using archive::Outcome;

std::string in_words(const archive::Sent& sent, const std::string& study) {
    switch (sent.outcome) {
        case Outcome::stored:
            return "stored in " + study;
        case Outcome::stored_with_doubt:
            return fmt::format("stored in {}, but {}", study, sent.reason);
        case Outcome::was_there:
            return fmt::format("was there already in {}; nothing was sent", study);
        case Outcome::refused:
            break;
    }
    return "refused: " + sent.reason;
}

/// nullopt: the archive has it.
std::optional<Error> send(archive::Http& http, const fs::path& file, const DicomObject& object, Console& console) {
    try {
        const archive::Sent sent = archive::send_object(http, file, object, console.work());
        const std::string study = archive::Address{http.service().service, object.study_uid, "", ""}.text();
        const std::string line = fmt::format("{}: {}", file.string(), in_words(sent, study));
        if (sent.outcome == Outcome::refused) return Error(ErrorKind::io, line);
        if (sent.outcome == Outcome::stored_with_doubt) console.warn(line);
        else console.print(line + "\n");
        return std::nullopt;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled)
            throw EndedEarly(
                "interrupted; what is not listed as stored may have been sent or not, and the same command sends it again "
                "if not",
                exit_code(error.kind()));
        return error;
    }
}

}  // namespace

void run(const SendCommand& command, Console& console) {
    const archive::Address address = archive::parse_address(command.address);
    if (!address.study_uid.empty())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("--archive {} names a study, which the files name themselves; the service is {}",
                                address.text(), address.service));
    std::vector<std::pair<fs::path, DicomObject>> objects;
    for (const fs::path& file : command.files) objects.emplace_back(file, dicom_object(file));
    archive::Http http(address, access_of(command.access));
    std::vector<Error> failures;
    for (const auto& [file, object] : objects)
        if (std::optional<Error> failure = send(http, file, object, console)) failures.push_back(*failure);
    if (failures.empty()) return;
    if (objects.size() == 1) throw failures.front();
    for (const Error& failure : failures) console.warn(failure.what());
    throw Error(failures.front().kind(),
                fmt::format("{} of {} were not stored; the same command sends them again, and leaves what is there",
                            failures.size(), counted(objects.size(), "object")));
}

}  // namespace kontur::app
