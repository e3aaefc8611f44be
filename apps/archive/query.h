// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "archive/http.h"

// QIDO-RS: what an archive has (DICOM PS3.18, 10.6). All texts are printable UTF-8, "" where the archive says nothing.

namespace kontur::archive {

struct StudyFilter {
    std::string name;        ///< of the patient; * and ? stand for others, and one without them is a beginning
    std::string patient_id;  ///< whole, unless it has a * or ?
    std::string date;        ///< YYYY-MM-DD, or two of them with .. between, of which one may be left out
    std::string modality;    ///< of one of its series, such as CT
    int most = 100;          ///< studies
};

struct Study {
    std::string uid, patient_name, patient_id, birth_date;
    std::string date;  ///< YYYY-MM-DD
    std::string description;
    std::vector<std::string> modalities;
    std::int64_t series = 0, instances = 0;  ///< how many; 0: unknown
};

struct Series {
    std::string uid, modality, number, description;
    std::int64_t instances = 0;  ///< how many; 0: unknown
};

struct Instance {
    std::string uid, number;
};

struct Studies {
    std::vector<Study> found;  ///< latest first
    bool has_more = false;     ///< than the filter takes
};

/// Throws Error(invalid_input) for the address of an object, and for a filter of studies where the address names one.
void check_can_be_listed(const Address& address, const StudyFilter& filter);

/// All throw what Http throws; Error(invalid_input) for a filter that is none and for what is not there, Error(corrupt_file)
/// for an answer that is no DICOM JSON (PS3.18, F), Error(too_large) for more than 100,000 entries.
Studies find_studies(Http& http, const StudyFilter& filter, const Work& work);
/// By number, then UID.
std::vector<Series> find_series(Http& http, const std::string& study_uid, const Work& work);
/// Those of a modality, at least one; "": all.
std::vector<Series> find_series_of(Http& http, const Address& study, const std::string& modality, const Work& work);
/// By number, then UID; series and study as `address` names them.
std::vector<Instance> find_instances(Http& http, const Address& address, const Work& work);

/// The object of this number, where the archive finds it so: a list of all may take seconds.
std::optional<Instance> find_numbered(Http& http, const Address& series, std::int64_t number, const Work& work);

/// How many objects a series has, which archives know sooner than which; 0: it does not say.
std::int64_t count_instances(Http& http, const Address& address, const Work& work);

/// Whether the archive has something that an address in the study or beside it names by its UID.
bool has_study(Http& http, const std::string& study_uid, const Work& work);
bool has_instance(Http& http, const std::string& study_uid, const std::string& instance_uid, const Work& work);

/// A series of images, rather than of what was made of them.
bool shows_images(const Series& series);

}  // namespace kontur::archive
