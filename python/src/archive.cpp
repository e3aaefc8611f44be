// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "archive.h"
#include "archive/cache.h"
#include "archive/fetch.h"
#include "archive/query.h"
#include "archive/send.h"
#include "kontur/base/error.h"
#include "notes.h"

namespace kontur::python {
namespace {

namespace fs = std::filesystem;
using archive::Address;
using archive::Http;

/// What a query found, with its address.
template <class Entry>
struct Found {
    Entry entry;
    std::string address;
};
using FoundStudy = Found<archive::Study>;
using FoundSeries = Found<archive::Series>;
using FoundInstance = Found<archive::Instance>;

/// Who asks, and whom he listens to.
struct Caller {
    std::optional<fs::path> credentials, ca;
    int give_up_s;
    py::object progress, stop;
};

/// The command's options are keywords here: "--give-up-s" is give_up_s.
std::string in_keywords(const std::string& sentence) {
    static const std::regex id(R"((^|[ (])--id\b)"), option(R"((^|[ (])--([a-z]+)(?:-([a-z]+))?(?:-([a-z]+))?\b)");
    std::string text = std::regex_replace(sentence, id, "$1patient_id"), result;
    std::smatch found;
    while (std::regex_search(text, found, option)) {
        result += found.prefix().str() + found[1].str() + found[2].str();
        for (const int n : {3, 4})
            if (found[n].matched) result += "_" + found[n].str();
        text = found.suffix();
    }
    return result + text;
}

/// What `task` makes; its errors name keywords.
template <class Task>
auto with_keywords(const Task& task) {
    try {
        return task();
    } catch (const Error& error) {
        throw Error(error.kind(), in_keywords(error.what()));
    }
}

/// Runs `task` with a connection to the address' service.
template <class Task>
auto run_there(const Caller& caller, const Address& address, const Task& task) {
    return with_keywords([&] {
        return run({caller.progress, caller.stop, 0}, [&](const Work& work) {
            Http http(address,
                      archive::read_access(caller.credentials.value_or(""), caller.ca.value_or(""), caller.give_up_s));
            return task(http, work);
        });
    });
}

Address address_from(const std::string& text) {
    return with_keywords([&] { return archive::parse_address(text); });
}

py::list find(const Address& address, const archive::StudyFilter& filter, const Caller& caller, const py::object& on_note) {
    py::list all;
    if (address.study_uid.empty()) {
        const archive::Studies found = run_there(
            caller, address, [&](Http& http, const Work& work) { return archive::find_studies(http, filter, work); });
        for (const archive::Study& one : found.found)
            all.append(FoundStudy{one, Address{address.service, one.uid, "", ""}.text()});
        if (found.has_more)
            give_notes({fmt::format("there are more than {} studies; most=N gives more of them", filter.most)}, on_note);
    } else if (address.series_uid.empty()) {
        for (const archive::Series& one : run_there(caller, address, [&](Http&http, const Work&work) {
                 return archive::find_series(http, address.study_uid, work);
             }))
            all.append(FoundSeries{one, Address{address.service, address.study_uid, one.uid, ""}.text()});
    } else {
        for (const archive::Instance& one : run_there(
                 caller, address, [&](Http&http, const Work&work) { return archive::find_instances(http, address, work); }))
            all.append(FoundInstance{one, Address{address.service, address.study_uid, address.series_uid, one.uid}.text()});
    }
    return all;
}

void fetch_into(Http& http, const Address& address, const fs::path& output, const std::string& modality, const Work& work) {
    archive::check_names_study(address);
    if (!address.instance_uid.empty()) return archive::fetch_instance(http, address, output, work);
    if (!address.series_uid.empty()) {
        archive::fetch_into_folder(http, address, output, work);
        return;
    }
    for (const archive::Series& one : archive::find_series_of(http, address, modality, work))
        archive::fetch_into_folder(http, {address.service, address.study_uid, one.uid, ""}, output / one.uid, work);
}

std::vector<archive::SentFile> send(Http& http, const std::vector<fs::path>& files, const Work& work) {
    std::vector<archive::SentFile> sent;
    const std::vector<Error> failures = archive::send_files(
        http, files, [&](const archive::SentFile& one) { sent.push_back(one); }, work);
    if (failures.empty()) return sent;
    if (files.size() == 1) throw failures.front();
    std::string reasons;
    for (const Error& failure : failures) reasons += fmt::format("\n{}", failure.what());
    throw Error(failures.front().kind(), archive::not_stored(failures, files.size()).what() + reasons);
}

const char* outcome(const archive::SentFile& one) {
    switch (one.sent.outcome) {
        case archive::Outcome::was_there:
            return "was there";
        case archive::Outcome::stored_with_doubt:
            return "stored with doubt";
        default:
            return "stored";
    }
}

template <class Entry>
class FoundType {
public:
    FoundType(py::module_& m, const char* name, const char* help) : type_(m, name, help) {
        type_.def_readonly("address", &Found<Entry>::address, "str: for `find` and `fetch`.");
        type_.def("__repr__", [](const py::object& self) {
            return py::str("<{} {!r}>").format(py::type::of(self).attr("__name__"), self.attr("address"));
        });
    }
    template <class Value>
    FoundType& field(const char* name, Value Entry::*member, const char* help) {
        type_.def_property_readonly(
            name, [member](const Found<Entry>& self) { return self.entry.*member; }, help);
        return *this;
    }

private:
    py::class_<Found<Entry>> type_;
};

void bind_types(py::module_& m) {
    using archive::Instance, archive::Series, archive::Study;
    FoundType<Study>(m, "Study", "A study of an archive. Texts are empty where the archive says nothing.")
        .field("study_uid", &Study::uid, "str")
        .field("date", &Study::date, "str: YYYY-MM-DD.")
        .field("patient_name", &Study::patient_name, "str")
        .field("patient_id", &Study::patient_id, "str")
        .field("birth_date", &Study::birth_date, "str: YYYY-MM-DD.")
        .field("modalities", &Study::modalities, "list of str")
        .field("description", &Study::description, "str")
        .field("series", &Study::series, "int: how many; 0 where that is not known.")
        .field("objects", &Study::instances, "int: likewise.");
    FoundType<Series>(m, "Series", "A series of a study.")
        .field("series_uid", &Series::uid, "str")
        .field("number", &Series::number, "str")
        .field("modality", &Series::modality, "str: 'CT', 'MR', ...")
        .field("description", &Series::description, "str")
        .field("objects", &Series::instances, "int: how many; 0 where that is not known.");
    FoundType<Instance>(m, "Instance", "An object of a series.")
        .field("instance_uid", &Instance::uid, "str")
        .field("number", &Instance::number, "str");
    py::class_<archive::SentFile> sent(m, "Sent", "A file that an archive has now.");
    sent.def_readonly("path", &archive::SentFile::file, "pathlib.Path");
    sent.def_readonly("study", &archive::SentFile::study, "str: the address of its study.");
    sent.def_property_readonly("outcome", &outcome, "{'stored', 'stored with doubt', 'was there'}");
    sent.def_property_readonly(
        "reason", [](const archive::SentFile& self) { return self.sent.reason; },
        "str: what the archive doubts; may be empty.");
    sent.def("__repr__", [](const archive::SentFile& self) { return "<Sent " + self.text() + ">"; });
}

const py::arg_v kCredentials = py::arg("credentials") = py::none();
const py::arg_v kCa = py::arg("ca") = py::none();
const py::arg_v kGiveUp = py::arg("give_up_s") = archive::Access{}.give_up_s;

void bind_find(py::module_& m) {
    const archive::StudyFilter defaults;
    define(
        m, "find", R"(Lists what an archive has: studies, latest first, the series of one, or the objects of a series.

Parameters
----------
address : str
name, patient_id, date, modality : str
    Only such studies: of a patient whose name begins so, of this number, of YYYY-MM-DD or FROM..TO, with such a series. Names
    and numbers may have * and ?.
most : int
    Studies at most.
credentials, ca : path, optional
give_up_s : int
on_note : callable, optional
    Is told when there are more studies; else the logger 'kontur' is.
stop : object with is_set(), optional

Returns
-------
list of Study or list of Series or list of Instance

Raises
------
InvalidInputError
    For what the archive does not have.
FileError
    For an archive that cannot be reached, is not trusted, falls silent or says no.
CorruptFileError
CancelledError
)",
        [](const std::string& address, std::string name, std::string patient_id, std::string date, std::string modality,
           int most, const std::optional<fs::path>& credentials, const std::optional<fs::path>& ca, int give_up_s,
           const py::object& on_note, const py::object& stop) {
            const archive::StudyFilter filter{std::move(name), std::move(patient_id), std::move(date), std::move(modality),
                                              most};
            const Address parsed = address_from(address);
            with_keywords([&] { archive::check_can_be_listed(parsed, filter); });
            return find(parsed, filter, {credentials, ca, give_up_s, py::none(), stop}, on_note);
        },
        py::arg("address"), py::kw_only(), py::arg("name") = defaults.name, py::arg("patient_id") = defaults.patient_id,
        py::arg("date") = defaults.date, py::arg("modality") = defaults.modality, py::arg("most") = defaults.most,
        kCredentials, kCa, kGiveUp, kOnNote, kStop);
}

void bind_fetch(py::module_& m) {
    define(
        m, "fetch", R"(Fetches a study, a series or an object, as it is stored.

Parameters
----------
address : str
output : path, optional
    A folder, in which each series of a study gets one of its own; of an object a file. What came before an error stays in
    FOLDER.part, and the same call goes on from there. Without it: into the user's cache, where nothing comes twice.
modality : str
    Of a study only such series; with `output`.
series : str, optional
    Which one of a study, by its UID; without `output`. May be left out where only one has images.
credentials, ca : path, optional
give_up_s : int
progress : callable, optional
    As for `kontur.segment`.
stop : object with is_set(), optional

Returns
-------
pathlib.Path
    What came, for `kontur.read_image` and the like.

Raises
------
InvalidInputError
    For what the archive does not have, and a folder that has other files.
FileError
    For an archive that cannot be reached, is not trusted, falls silent, ends early or says no.
CorruptFileError
    For what is no DICOM.
TooLargeError
    For an object over 4 GiB.
CancelledError
)",
        [](const std::string& address, const std::optional<fs::path>& output, const std::string& modality,
           const std::optional<std::string>& series, const std::optional<fs::path>& credentials,
           const std::optional<fs::path>& ca, int give_up_s, const py::object& progress, const py::object& stop) {
            const Address parsed = address_from(address);
            const bool is_study = parsed.series_uid.empty();
            if (!modality.empty() && (!output || !is_study))
                throw Error(ErrorKind::invalid_input, "modality chooses series of a study that come into a folder, output");
            if (series && (output || !is_study))
                throw Error(ErrorKind::invalid_input,
                            "series chooses one of a study that comes into the cache, without output");
            return run_there({credentials, ca, give_up_s, progress, stop}, parsed, [&](Http& http, const Work& work) {
                if (!output) return archive::fetch_what_is_read(http, parsed, series, false, work);
                fetch_into(http, parsed, *output, modality, work);
                return *output;
            });
        },
        py::arg("address"), py::arg("output") = py::none(), py::kw_only(), py::arg("modality") = "",
        py::arg("series") = py::none(), kCredentials, kCa, kGiveUp, kProgress, kStop);
}

void bind_send(py::module_& m) {
    define(
        m, "send", R"(Stores DICOM files as new objects of their studies, never over others.

Parameters
----------
files : sequence of path
archive : str
    The address of the service.
credentials, ca : path, optional
give_up_s : int
progress : callable, optional
    As for `kontur.segment`.
stop : object with is_set(), optional

Returns
-------
list of Sent

Raises
------
FileError
    When the archive does not take a file, with its reason; the others are sent. The same call sends it again.
InvalidInputError
    For a study that the archive does not have.
CorruptFileError
    For a file that is no DICOM object, before anything is sent.
TooLargeError
    For what the archive takes nothing as large as.
CancelledError
)",
        [](const std::vector<fs::path>& files, const std::string& archive, const std::optional<fs::path>& credentials,
           const std::optional<fs::path>& ca, int give_up_s, const py::object& progress, const py::object& stop) {
            const Address address = address_from(archive);
            return run_there({credentials, ca, give_up_s, progress, stop}, address, [&](Http& http, const Work& work) {
                kontur::archive::check_is_service(address);
                return send(http, files, work);
            });
        },
        py::arg("files"), py::arg("archive"), py::kw_only(), kCredentials, kCa, kGiveUp, kProgress, kStop);
}

}  // namespace

void bind_archive(py::module_& archive) {
    bind_types(archive);
    bind_find(archive);
    bind_fetch(archive);
    bind_send(archive);
}

}  // namespace kontur::python
