// SPDX-License-Identifier: Apache-2.0
#include "archive/send.h"

#include <vector>

#include "commands.h"
#include "kontur/base/error.h"

namespace kontur::app {
namespace {

std::vector<Error> sent(archive::Http& http, const SendCommand& command, Console& console) {
    const auto tell = [&](const archive::SentFile& one) {
        if (one.sent.outcome == archive::Outcome::stored_with_doubt) console.warn(one.text());
        else console.print(one.text() + "\n");
    };
    try {
        return archive::send_files(http, command.files, tell, console.work());
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::cancelled) throw;
        throw EndedEarly(
            "interrupted; what is not listed as stored may have been sent or not, and the same command sends it again if "
            "not",
            exit_code(error.kind()));
    }
}

}  // namespace

void run(const SendCommand& command, Console& console) {
    const archive::Address address = archive::parse_address(command.address);
    archive::check_is_service(address);
    archive::Http http(address, access_of(command.access));
    const std::vector<Error> failures = sent(http, command, console);
    if (failures.empty()) return;
    if (command.files.size() == 1) throw failures.front();
    for (const Error& failure : failures) console.warn(failure.what());
    throw archive::not_stored(failures, command.files.size());
}

}  // namespace kontur::app
