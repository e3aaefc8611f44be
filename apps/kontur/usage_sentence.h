// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kontur::app {

/// What the parser of the command line says of wrong words, as kontur says it: the option, what was given, what is possible.
/// A sentence that is not known stays as it is.
std::string usage_sentence(const std::string& of_parser);

/// A sentence of the library, which names "the option allow_missing_geometry", with options as they are typed:
/// "--allow-missing-geometry".
std::string with_typed_options(const std::string& of_library);

}  // namespace kontur::app
