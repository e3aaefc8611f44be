// SPDX-License-Identifier: Apache-2.0
#include "archive/query.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <tuple>
#include <utility>

#include "archive/dicom_json.h"
#include "archive/refusal.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_date.h"

namespace kontur::archive {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMostAnswerBytes = std::uint64_t{64} << 20;
constexpr int kMostAnswerSeconds = 300;
constexpr std::size_t kPage = 1000;
constexpr std::size_t kMostEntries = 100'000;

std::string escaped(std::string_view text) {
    std::string address;
    for (const unsigned char c : text) {
        const bool is_plain =
            std::isalnum(c) || std::string_view("-._~*?").find(static_cast<char>(c)) != std::string_view::npos;
        address += is_plain && c != '?' ? std::string{static_cast<char>(c)} : fmt::format("%{:02X}", c);
    }
    return address;
}

std::vector<json> ask_once(Http& http, const std::string& path, const std::string& what, const Work& work) {
    Request request;
    request.path = path;
    request.headers = {"Accept: application/dicom+json"};
    request.most_bytes = kMostAnswerBytes;
    request.most_seconds = kMostAnswerSeconds;
    const Answer answer = http.ask(request, work);
    if (answer.status == 204) return {};
    if (answer.status != 200) throw refusal(answer, http, what);
    if (!answer.content_type.empty() && answer.content_type.find("json") == std::string::npos)
        throw Error(ErrorKind::corrupt_file,
                    fmt::format("{} answers with {}, not with JSON: it is no DICOMweb service, or not at this address",
                                http.service().service, answer.content_type));
    return json_objects(answer.body);
}

/// All entries, page by page: archives give fewer at a time than they are asked for. One that knows no pages begins again,
/// which the first entry tells.
std::vector<json> ask_all(Http& http, const std::string& path, const char* uid_tag, const Work& work) {
    std::vector<json> all;
    std::set<std::string> uids;
    const char joint = path.find('?') == std::string::npos ? '?' : '&';
    for (;;) {
        const std::vector<json> page = ask_once(http, fmt::format("{}{}limit={}&offset={}", path, joint, kPage, all.size()),
                                                http.service().service, work);
        const std::size_t before = all.size();
        for (const json& entry : page)
            if (std::string uid = value_of(entry, uid_tag); is_uid(uid) && uids.insert(std::move(uid)).second)
                all.push_back(entry);
        if (all.size() > kMostEntries)
            throw Error(ErrorKind::too_large,
                        fmt::format("{} lists more than {} entries", http.service().host(), kMostEntries));
        if (all.size() == before) return all;
    }
}

/// YYYYMMDD of YYYY-MM-DD.
std::string stored_date(std::string_view date, std::string_view whole) {
    std::string digits;
    for (const char c : date)
        if (c != '-') digits += c;
    const bool is_date = digits.size() == 8 &&
                         (date.size() == 8 || (date.size() == 10 && date[4] == '-' && date[7] == '-')) &&
                         std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!is_date)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("--date {} is no date; it is YYYY-MM-DD, or FROM..TO of two of them", whole));
    return digits;
}

std::string stored_dates(std::string_view date) {
    const std::size_t dots = date.find("..");
    if (dots == std::string_view::npos) return stored_date(date, date);
    const std::string_view from = date.substr(0, dots), to = date.substr(dots + 2);
    if (from.empty() && to.empty()) return stored_date("", date);
    return (from.empty() ? "" : stored_date(from, date)) + "-" + (to.empty() ? "" : stored_date(to, date));
}

std::string readable_name(std::string name) {
    while (!name.empty() && name.back() == '^') name.pop_back();
    const std::size_t family = name.find('^');
    if (family != std::string::npos) name.replace(family, 1, ", ");
    std::replace(name.begin(), name.end(), '^', ' ');
    return name;
}

Study study_of(const json& entry) {
    return {.uid = value_of(entry, "0020000D"),
            .patient_name = readable_name(value_of(entry, "00100010")),
            .patient_id = value_of(entry, "00100020"),
            .birth_date = readable_date(value_of(entry, "00100030")),
            .date = readable_date(value_of(entry, "00080020")),
            .description = value_of(entry, "00081030"),
            .modalities = values_of(entry, "00080061"),
            .series = count_of(entry, "00201206"),
            .instances = count_of(entry, "00201208")};
}

Instance instance_of(const json& entry) {
    return {.uid = value_of(entry, "00080018"), .number = value_of(entry, "00200013")};
}

std::string query_of(const StudyFilter& filter) {
    std::string name = filter.name;
    if (!name.empty() && name.find_first_of("*?") == std::string::npos) name += '*';
    const std::array<std::pair<const char*, std::string>, 4> terms{
        {{"PatientName", name},
         {"PatientID", filter.patient_id},
         {"StudyDate", filter.date.empty() ? "" : stored_dates(filter.date)},
         {"ModalitiesInStudy", filter.modality}}};
    std::string query = fmt::format("/studies?limit={}", filter.most + 1);
    for (const char* tag : {"00080061", "00081030", "00100030", "00201206", "00201208"})
        query += fmt::format("&includefield={}", tag);
    for (const auto& [name_of_term, value] : terms)
        if (!value.empty()) query += fmt::format("&{}={}", name_of_term, escaped(value));
    return query;
}

std::string level_path(const std::string& study_uid, const std::string& series_uid) {
    return "/studies/" + study_uid + "/series" + (series_uid.empty() ? "" : "/" + series_uid + "/instances");
}

template <class Entry>
void sort_by_number(std::vector<Entry>& entries) {
    const auto key = [](const Entry& entry) { return std::tuple(entry.number.size(), entry.number, entry.uid); };
    std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) { return key(a) < key(b); });
}

[[noreturn]] void miss(const Http& http, const Address& address) {
    throw Error(ErrorKind::invalid_input, fmt::format("{} does not have {}", http.service().host(), address.text()));
}

}  // namespace

void check_can_be_listed(const Address& address, const StudyFilter& filter) {
    if (!address.instance_uid.empty())
        throw Error(ErrorKind::invalid_input, fmt::format("{0} is one object; kontur fetch {0} fetches it", address.text()));
    const bool has_filter =
        !(filter.name + filter.patient_id + filter.date + filter.modality).empty() || filter.most != StudyFilter{}.most;
    if (!address.study_uid.empty() && has_filter)
        throw Error(ErrorKind::invalid_input,
                    "--name, --id, --date, --modality and --most choose studies; the address names one already");
}

Studies find_studies(Http& http, const StudyFilter& filter, const Work& work) {
    Studies studies;
    for (const json& entry : ask_once(http, query_of(filter), http.service().service, work))
        if (Study study = study_of(entry); is_uid(study.uid)) studies.found.push_back(std::move(study));
    std::stable_sort(studies.found.begin(), studies.found.end(),
                     [](const Study& a, const Study& b) { return a.date > b.date; });
    const std::size_t most = static_cast<std::size_t>(filter.most);
    studies.has_more = studies.found.size() > most;
    if (studies.has_more) studies.found.resize(most);
    return studies;
}

std::vector<Series> find_series(Http& http, const std::string& study_uid, const Work& work) {
    std::vector<Series> all;
    const std::string path = level_path(study_uid, "") + "?includefield=0008103E&includefield=00201209";
    for (const json& entry : ask_all(http, path, "0020000E", work))
        all.push_back({.uid = value_of(entry, "0020000E"),
                       .modality = value_of(entry, "00080060"),
                       .number = value_of(entry, "00200011"),
                       .description = value_of(entry, "0008103E"),
                       .instances = count_of(entry, "00201209")});
    if (all.empty()) miss(http, {http.service().service, study_uid, "", ""});
    sort_by_number(all);
    return all;
}

std::vector<Series> find_series_of(Http& http, const Address& study, const std::string& modality, const Work& work) {
    std::vector<Series> all = find_series(http, study.study_uid, work);
    if (!modality.empty()) std::erase_if(all, [&](const Series& one) { return one.modality != modality; });
    if (all.empty())
        throw Error(ErrorKind::invalid_input, fmt::format("{} has no series of --modality {}", study.text(), modality));
    return all;
}

std::vector<Instance> find_instances(Http& http, const Address& address, const Work& work) {
    std::vector<Instance> all;
    for (const json& entry : ask_all(http, level_path(address.study_uid, address.series_uid), "00080018", work))
        all.push_back(instance_of(entry));
    if (all.empty()) miss(http, {address.service, address.study_uid, address.series_uid, ""});
    sort_by_number(all);
    return all;
}

std::optional<Instance> find_numbered(Http& http, const Address& series, std::int64_t number, const Work& work) {
    const std::string text = fmt::format("{}", number);
    const std::string path =
        fmt::format("{}?limit=1&InstanceNumber={}", level_path(series.study_uid, series.series_uid), text);
    for (const json& entry : ask_once(http, path, series.text(), work))
        if (const Instance found = instance_of(entry); found.number == text && is_uid(found.uid)) return found;
    return std::nullopt;
}

std::int64_t count_instances(Http& http, const Address& address, const Work& work) {
    const std::string path =
        level_path(address.study_uid, "") + "?includefield=00201209&SeriesInstanceUID=" + address.series_uid;
    const std::vector<json> found = ask_once(http, path, address.text(), work);
    if (found.empty()) miss(http, address);
    return found.size() == 1 ? count_of(found.front(), "00201209") : 0;
}

bool has_study(Http& http, const std::string& study_uid, const Work& work) {
    return !ask_once(http, "/studies?limit=1&StudyInstanceUID=" + study_uid, http.service().service, work).empty();
}

bool has_instance(Http& http, const std::string& study_uid, const std::string& instance_uid, const Work& work) {
    return !ask_once(http, fmt::format("/studies/{}/instances?limit=1&SOPInstanceUID={}", study_uid, instance_uid),
                     http.service().service, work)
                .empty();
}

bool shows_images(const Series& series) {
    constexpr std::array kOthers{"SEG", "RTSTRUCT", "RTPLAN", "RTDOSE", "RTRECORD", "REG",
                                 "SR",  "PR",       "KO",     "DOC",    "AU",       "ECG"};
    return std::find(kOthers.begin(), kOthers.end(), series.modality) == kOthers.end();
}

}  // namespace kontur::archive
