// SPDX-License-Identifier: Apache-2.0
#include "archive_words.h"

#include <fmt/format.h>

#include <array>

#include "archive/cache.h"
#include "kontur/base/error.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

fs::path fetched(const archive::Address& address, const std::optional<std::string>* series, const ArchiveWords& words,
                 Console& console) {
    archive::Http http(address, access_of(words.options));
    return archive::fetch_what_is_read(http, address, series ? *series : std::nullopt, words.with_drawings, console.work());
}

}  // namespace

archive::Access access_of(const ArchiveOptions& options) {
    return archive::read_access(options.credentials, options.ca, options.give_up_s);
}

void fetch_addresses(const ArchiveWords& words, Console& console) {
    std::vector<ArchiveWords::Place> places = words.places;
    for (const ArchiveWords::List& list : words.lists)
        for (fs::path& path : *list.paths) places.push_back({&path, list.series});
    std::erase_if(places, [](const ArchiveWords::Place& place) { return !archive::is_address(place.path->native()); });
    const ArchiveOptions defaults;
    const ArchiveOptions& options = words.options;
    if (places.empty() && (!options.credentials.empty() || !options.ca.empty() || options.give_up_s != defaults.give_up_s))
        throw Error(ErrorKind::invalid_input,
                    "--credentials, --ca and --give-up-s are for addresses of an archive (https://...), and none is given");
    for (const ArchiveWords::Place& place : places) {
        const archive::Address address = archive::parse_address(place.path->native());
        *place.path = fetched(address, place.series, words, console);
        console.note(std::array{
            fmt::format("{} is in {}; delete it there when you no longer need it", address.text(), place.path->string())});
    }
}

}  // namespace kontur::app
