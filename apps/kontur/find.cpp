// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "archive/query.h"
#include "commands.h"
#include "facts.h"
#include "kontur/base/counted.h"

namespace kontur::app {
namespace {

using archive::Address;

/// What is known, with commas between.
std::string joined(std::initializer_list<std::string> words) {
    std::string all;
    for (const std::string& word : words)
        if (!word.empty()) all += (all.empty() ? "" : ", ") + word;
    return all;
}

std::string count_of_series(std::int64_t number) { return number > 0 ? fmt::format("{} series", number) : ""; }

std::string count_of_objects(std::int64_t number) { return number > 0 ? counted(number, "object") : ""; }

/// What is found, for people and for programs.
struct Listing {
    std::string text;
    Facts facts = Facts::array();
};

void add(Listing& listing, const Address& address, const std::string& words, Facts facts) {
    listing.text += fmt::format("{}\n    {}\n", words, address.text());
    facts["address"] = address.text();
    listing.facts.push_back(std::move(facts));
}

Listing list_studies(archive::Http& http, const FindCommand& command, Console& console) {
    Listing listing;
    const archive::Studies studies = archive::find_studies(http, command.filter, console.work());
    for (const archive::Study& study : studies.found)
        add(listing, {http.service().service, study.uid, "", ""},
            joined({study.date, study.patient_name, study.patient_id.empty() ? "" : "number " + study.patient_id,
                    fmt::format("{}", fmt::join(study.modalities, " ")), study.description, count_of_series(study.series),
                    count_of_objects(study.instances)}),
            {{"study_uid", study.uid},
             {"date", study.date},
             {"patient_name", study.patient_name},
             {"patient_id", study.patient_id},
             {"birth_date", study.birth_date},
             {"modalities", study.modalities},
             {"description", study.description},
             {"series", study.series},
             {"objects", study.instances}});
    if (studies.has_more)
        console.warn(
            fmt::format("there are more than {} studies; --most shows more of them, --name, --id, --date and "
                        "--modality choose among them",
                        command.filter.most));
    return listing;
}

Listing list_series(archive::Http& http, const Address& study, Console& console) {
    Listing listing;
    for (const archive::Series& series : archive::find_series(http, study.study_uid, console.work()))
        add(listing, {study.service, study.study_uid, series.uid, ""},
            joined({series.number.empty() ? "" : "series " + series.number, series.modality, series.description,
                    count_of_objects(series.instances)}),
            {{"series_uid", series.uid},
             {"number", series.number},
             {"modality", series.modality},
             {"description", series.description},
             {"objects", series.instances}});
    return listing;
}

Listing list_instances(archive::Http& http, const Address& series, Console& console) {
    Listing listing;
    for (const archive::Instance& instance : archive::find_instances(http, series, console.work()))
        add(listing, {series.service, series.study_uid, series.series_uid, instance.uid},
            instance.number.empty() ? "object" : "object " + instance.number,
            {{"instance_uid", instance.uid}, {"number", instance.number}});
    return listing;
}

}  // namespace

void run(const FindCommand& command, Console& console) {
    const Address address = archive::parse_address(command.address);
    archive::check_can_be_listed(address, command.filter);
    archive::Http http(address, access_of(command.access));
    const Listing listing = address.study_uid.empty()    ? list_studies(http, command, console)
                            : address.series_uid.empty() ? list_series(http, address, console)
                                                         : list_instances(http, address, console);
    console.print(command.json ? to_json_text(listing.facts) : listing.text.empty() ? "nothing found\n" : listing.text);
}

}  // namespace kontur::app
