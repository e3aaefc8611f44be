// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kontur/base/error.h"

namespace kontur::app {

/// The result of `body()`; an Error(invalid_input) that leaves it names the file whose fault it is.
template <class Body>
auto in_faults_of(const std::filesystem::path& file, const Body& body) {
    try {
        return body();
    } catch (const Error& error) {
        throw error.kind() == ErrorKind::invalid_input ? error.with_context(file.string()) : error;
    }
}

}  // namespace kontur::app
