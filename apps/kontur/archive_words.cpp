// SPDX-License-Identifier: Apache-2.0
#include "archive_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <system_error>

#include "archive/cache.h"
#include "archive/query.h"
#include "kontur/base/error.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;
using archive::Address;
using archive::Http;
using archive::Series;

std::string in_words(const Series& series) {
    return fmt::format("{} ({}{}{})", series.uid, series.modality, series.description.empty() ? "" : ", ",
                       series.description);
}

/// The one series of images that a study has.
std::string only_series(const std::vector<Series>& all, const Address& study) {
    std::vector<const Series*> images;
    for (const Series& one : all)
        if (archive::shows_images(one)) images.push_back(&one);
    if (images.size() == 1) return images.front()->uid;
    constexpr std::size_t kMostListed = 8;
    std::string listed;
    for (std::size_t n = 0; n < std::min(images.size(), kMostListed); ++n)
        listed += (n > 0 ? ", " : "") + in_words(*images[n]);
    if (images.size() > kMostListed) listed += ", ...";
    throw Error(ErrorKind::invalid_input,
                images.empty() ? fmt::format("{} has no series of images", study.text())
                               : fmt::format("{} has {} series of images; choose one with --series or by its address "
                                             "(.../series/UID): {}",
                                             study.text(), images.size(), listed));
}

fs::path fetched(Address address, const std::optional<std::string>* series, const ArchiveWords& words, Console& console) {
    archive::check_names_study(address);
    Http http(address, access_of(words.options));
    if (!address.instance_uid.empty()) return archive::fetch_object_to_cache(http, address, console.work());
    const bool is_study = address.series_uid.empty();
    if (is_study || words.with_drawings) {
        const std::vector<Series> all = archive::find_series(http, address.study_uid, console.work());
        if (is_study) address.series_uid = series && *series ? **series : only_series(all, address);
        if (words.with_drawings) archive::fetch_drawings_to_cache(http, all, address, console.work());
    }
    return archive::fetch_to_cache(http, address, console.work());
}

}  // namespace

archive::Access access_of(const ArchiveOptions& options) {
    std::error_code ignored;
    if (!options.ca.empty() && !fs::is_regular_file(options.ca, ignored))
        throw Error(ErrorKind::io, fmt::format("cannot read --ca {}: it is no file", options.ca.string()));
    return {archive::read_credentials(options.credentials), options.ca, options.give_up_s};
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
        const Address address = archive::parse_address(place.path->native());
        *place.path = fetched(address, place.series, words, console);
        console.note(std::array{
            fmt::format("{} is in {}; delete it there when you no longer need it", address.text(), place.path->string())});
    }
}

}  // namespace kontur::app
