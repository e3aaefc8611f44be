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

}  // namespace

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
