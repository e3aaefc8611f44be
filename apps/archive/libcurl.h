// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <curl/curl.h>

namespace kontur::archive {

/// What is called of libcurl, by the names that it has there without "curl_".
struct LibCurl {
    decltype(&curl_global_init) global_init;
    decltype(&curl_easy_init) easy_init;
    decltype(&curl_easy_cleanup) easy_cleanup;
    decltype(&curl_easy_reset) easy_reset;
    decltype(&curl_easy_setopt) easy_setopt;
    decltype(&curl_easy_getinfo) easy_getinfo;
    decltype(&curl_easy_perform) easy_perform;
    decltype(&curl_easy_strerror) easy_strerror;
    decltype(&curl_slist_append) slist_append;
    decltype(&curl_slist_free_all) slist_free_all;
    decltype(&curl_url) url;
    decltype(&curl_url_set) url_set;
    decltype(&curl_url_get) url_get;
    decltype(&curl_url_cleanup) url_cleanup;
    decltype(&curl_free) free;
};

/// Loaded with the first call: it brings two dozen libraries, and most commands ask no archive. Throws Error(unsupported)
/// where it is not to be found.
const LibCurl& libcurl();

}  // namespace kontur::archive
