// SPDX-License-Identifier: Apache-2.0
#include "archive/address.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"

namespace kontur::archive {
namespace {

constexpr std::array<std::string_view, 2> kSchemes{"https://", "http://"};
constexpr std::string_view kStudies = "/studies";

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

std::size_t scheme_length(std::string_view word) {
    const std::string small = lower_case(word.substr(0, 8));
    for (const std::string_view scheme : kSchemes)
        if (small.starts_with(scheme)) return scheme.size();
    return 0;
}

/// What must not be quoted is refused first.
void check_characters(std::string_view word, std::string_view authority) {
    if (authority.find('@') != std::string_view::npos)
        refuse("an address carries no user and no password; put user:password into a file and name that with --credentials");
    if (word.find_first_of("?#") != std::string_view::npos)
        refuse("an address carries no ? and no #; it is https://HOST/PATH, or that and /studies/UID");
    if (!std::all_of(word.begin(), word.end(), [](unsigned char c) { return c > ' ' && c < 0x7f; }))
        refuse(fmt::format("{} has characters that belong into no address", printable_utf8(word)));
    if (authority.empty() || authority.front() == ':') refuse(fmt::format("{} names no host", word));
}

std::vector<std::string_view> segments_of(std::string_view path) {
    std::vector<std::string_view> segments;
    while (!path.empty()) {
        const std::size_t end = std::min(path.find('/'), path.size());
        if (end > 0) segments.push_back(path.substr(0, end));
        path.remove_prefix(std::min(end + 1, path.size()));
    }
    return segments;
}

void read_uids(std::string_view word, std::string_view path, Address& address) {
    const std::array<std::pair<std::string_view, std::string*>, 3> levels{
        {{"studies", &address.study_uid}, {"series", &address.series_uid}, {"instances", &address.instance_uid}}};
    const std::vector<std::string_view> segments = segments_of(path);
    for (std::size_t n = 0; n < segments.size(); n += 2) {
        if (n / 2 >= levels.size() || segments[n] != levels[n / 2].first)
            refuse(fmt::format("{} is no address of a study; that is SERVICE/studies/UID, of a series that and /series/UID",
                               word));
        if (n + 1 == segments.size()) return;  // the list of what is there
        if (!is_uid(segments[n + 1])) refuse(fmt::format("{} in {} is no UID (digits and dots)", segments[n + 1], word));
        *levels[n / 2].second = segments[n + 1];
    }
}

}  // namespace

bool is_uid(std::string_view text) {
    return !text.empty() && text.size() <= 64 && text.front() != '.' &&
           std::all_of(text.begin(), text.end(), [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
}

bool is_address(std::string_view word) { return scheme_length(word) > 0; }

Address parse_address(std::string_view word) {
    const std::size_t scheme = scheme_length(word);
    if (scheme == 0) refuse(fmt::format("{} is no address of an archive; that begins with https://", printable_utf8(word)));
    const std::string_view rest = word.substr(scheme), authority = rest.substr(0, rest.find_first_of("/?#"));
    check_characters(word, authority);
    std::size_t end = std::string_view::npos;  // of the service
    for (std::size_t at = word.find(kStudies, scheme); at != std::string_view::npos; at = word.find(kStudies, at + 1))
        if (at + kStudies.size() == word.size() || word[at + kStudies.size()] == '/') end = at;
    Address address;
    address.service = lower_case(word.substr(0, scheme)) + std::string(word.substr(0, end).substr(scheme));
    while (address.service.ends_with('/')) address.service.pop_back();
    if (end != std::string_view::npos) read_uids(word, word.substr(end), address);
    return address;
}

void check_names_study(const Address& address) {
    if (address.study_uid.empty()) refuse(fmt::format("{0} names no study; kontur find {0} lists them", address.text()));
}

void check_is_service(const Address& address) {
    if (!address.study_uid.empty())
        refuse(fmt::format("--archive {} names a study, which the files name themselves; the service is {}", address.text(),
                           address.service));
}

std::string Address::text() const {
    std::string text = service;
    if (!study_uid.empty()) text += "/studies/" + study_uid;
    if (!series_uid.empty()) text += "/series/" + series_uid;
    if (!instance_uid.empty()) text += "/instances/" + instance_uid;
    return text;
}

std::string Address::host() const {
    const std::string rest = service.substr(scheme_length(service));
    return rest.substr(0, rest.find('/'));
}

bool Address::is_this_machine() const {
    const std::string name = host();
    if (name.starts_with("[")) return name.starts_with("[::1]");
    const std::string bare = lower_case(name.substr(0, name.find(':')));
    return bare == "localhost" || bare == "127.0.0.1";
}

}  // namespace kontur::archive
