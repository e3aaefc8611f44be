// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace kontur::app {

/// What the parser of the command line says of wrong words, as kontur says it: the option, what was given, what is possible.
/// A sentence that is not known stays as it is.
std::string usage_sentence(const std::string& of_parser);

/// A sentence of the library, which names "the option allow_missing_geometry", with options as they are typed:
/// "--allow-missing-geometry". Those that are not among the `available` ones of the command are `kontur convert`'s, which
/// makes a file that the command reads.
std::string with_typed_options(const std::string& of_library, std::span<const std::string> available);

}  // namespace kontur::app
