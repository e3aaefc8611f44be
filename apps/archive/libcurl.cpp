// SPDX-License-Identifier: Apache-2.0
#include "archive/libcurl.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "kontur/base/error.h"

namespace kontur::archive {
namespace {

[[noreturn]] void refuse() {
    throw Error(ErrorKind::unsupported,
                fmt::format("archives need libcurl, which cannot be loaded ({}); Debian has it as libcurl4", dlerror()));
}

/// Its routines by name, as kontur/solve/blas.cpp takes those of OpenBLAS.
template <class Routine>
void find(void* library, const char* name, Routine& routine) {
    routine = reinterpret_cast<Routine>(dlsym(library, name));
    if (!routine) refuse();
}

LibCurl load() {
    void* library = dlopen(KONTUR_LIBCURL, RTLD_NOW | RTLD_LOCAL);
    if (!library) refuse();
    LibCurl curl{};
    find(library, "curl_global_init", curl.global_init);
    find(library, "curl_easy_init", curl.easy_init);
    find(library, "curl_easy_cleanup", curl.easy_cleanup);
    find(library, "curl_easy_reset", curl.easy_reset);
    find(library, "curl_easy_setopt", curl.easy_setopt);
    find(library, "curl_easy_getinfo", curl.easy_getinfo);
    find(library, "curl_easy_perform", curl.easy_perform);
    find(library, "curl_easy_strerror", curl.easy_strerror);
    find(library, "curl_slist_append", curl.slist_append);
    find(library, "curl_slist_free_all", curl.slist_free_all);
    find(library, "curl_url", curl.url);
    find(library, "curl_url_set", curl.url_set);
    find(library, "curl_url_get", curl.url_get);
    find(library, "curl_url_cleanup", curl.url_cleanup);
    find(library, "curl_free", curl.free);
    curl.global_init(CURL_GLOBAL_DEFAULT);
    return curl;
}

}  // namespace

const LibCurl& libcurl() {
    static const LibCurl curl = load();
    return curl;
}

}  // namespace kontur::archive
