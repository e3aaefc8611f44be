// SPDX-License-Identifier: Apache-2.0
#include "archive/cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>

#include "archive/fetch.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/folders.h"

namespace kontur::archive {
namespace {

namespace fs = std::filesystem;

fs::path cache_folder() {
    const std::optional<fs::path> caches = user_folder("XDG_CACHE_HOME", ".cache");
    if (!caches) throw Error(ErrorKind::io, "neither XDG_CACHE_HOME nor HOME says where images of an archive may be kept");
    const fs::path folder = *caches / "kontur/archive";
    make_folder(folder);
    std::error_code failure;
    fs::permissions(folder, fs::perms::owner_all, failure);
    if (failure) throw Error(ErrorKind::io, fmt::format("cannot make {}: {}", folder.string(), failure.message()));
    return folder;
}

fs::path service_folder(const Address& address) {
    std::string host = address.host();
    std::replace(host.begin(), host.end(), ':', '_');
    return cache_folder() / host;
}

fs::path study_folder(const Address& address) { return service_folder(address) / address.study_uid; }

fs::path path_of(const fs::path& folder) {
    const std::vector<fs::path> files{fs::directory_iterator(folder), {}};
    return files.size() == 1 ? files.front() : folder;
}

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

}  // namespace

std::vector<fs::path> cache_places(const Address& series) {
    const fs::path folder = study_folder(series) / series.series_uid;
    return {part_folder(folder), folder};
}

fs::path fetch_to_cache(Http& http, const Address& series, const Work& work) {
    const fs::path folder = study_folder(series) / series.series_uid;
    FetchedSeries progress;
    try {
        fetch_series(http, series, folder, progress, work);
    } catch (const Error& error) {
        if (progress.arrived == 0) throw;
        throw Error(error.kind(), fmt::format("{}; {} of {} objects are kept, and the same again goes on from there",
                                              error.what(), progress.arrived, progress.objects));
    }
    return path_of(folder);
}

void fetch_drawings_to_cache(Http& http, const std::vector<Series>& all, const Address& study, const Work& work) {
    for (const Series& one : all)
        if (one.modality == "SEG" || one.modality == "RTSTRUCT")
            fetch_to_cache(http, {study.service, study.study_uid, one.uid, ""}, work);
}

fs::path fetch_what_is_read(Http& http, Address address, const std::optional<std::string>& series_uid, bool with_drawings,
                            const Work& work) {
    check_names_study(address);
    if (!address.instance_uid.empty()) return fetch_object_to_cache(http, address, work);
    const bool is_study = address.series_uid.empty();
    if (is_study || with_drawings) {
        const std::vector<Series> all = find_series(http, address.study_uid, work);
        if (is_study) address.series_uid = series_uid ? *series_uid : only_series(all, address);
        if (with_drawings) fetch_drawings_to_cache(http, all, address, work);
    }
    return fetch_to_cache(http, address, work);
}

bool came_from(const Address& service, const fs::path& path) {
    std::error_code failure;
    const fs::path folder = fs::weakly_canonical(service_folder(service), failure),
                   file = fs::weakly_canonical(path, failure);
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

fs::path fetch_object_to_cache(Http& http, const Address& instance, const Work& work) {
    const fs::path file = study_folder(instance) / (instance.series_uid + ".objects") / (instance.instance_uid + ".dcm");
    fetch_instance(http, instance, file, work);
    return file;
}

}  // namespace kontur::archive
