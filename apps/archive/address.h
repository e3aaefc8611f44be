// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace kontur::archive {

/// A DICOMweb service, or a study, a series or an object in it.
struct Address {
    std::string service;       ///< such as "https://host/dicom-web"
    std::string study_uid;     ///< empty: the service itself; likewise the next ones
    std::string series_uid;    ///< of `study_uid`
    std::string instance_uid;  ///< of `series_uid`

    /// As a person types it.
    std::string text() const;
    /// Host and port, such as "host:8042".
    std::string host() const;
    bool is_encrypted() const { return service.starts_with("https:"); }
    /// Reached without a network: what is sent there passes nobody by.
    bool is_this_machine() const;
};

/// Whether a word names something in an archive rather than a file: it begins with http:// or https://.
bool is_address(std::string_view word);

/// SERVICE, SERVICE/studies/UID, .../series/UID or .../instances/UID. Throws Error(invalid_input) for anything else, for
/// UIDs that are none, and, without quoting it, for an address that carries a password or a query.
Address parse_address(std::string_view word);

/// Throws Error(invalid_input) for the address of a service.
void check_names_study(const Address& address);

/// Throws Error(invalid_input) for the address of something in a service.
void check_is_service(const Address& address);

/// Digits and dots, 64 at most (DICOM PS3.5, 9.1).
bool is_uid(std::string_view text);

}  // namespace kontur::archive
