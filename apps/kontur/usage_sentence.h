// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kontur::app {

/// What the parser of the command line says of wrong words, as kontur says it: the option, what was given, what is possible.
/// A sentence that is not known stays as it is.
std::string usage_sentence(const std::string& of_parser);

}  // namespace kontur::app
