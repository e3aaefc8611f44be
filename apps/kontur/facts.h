// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "kontur/shape/provenance.h"

namespace kontur::app {

/// What a command found out, as ordered names and values: printed as JSON for programs or as text for people, with the same
/// names. A name carries its unit (`volume_ml`).
using Facts = nlohmann::ordered_json;

/// One line for each name; a list of lists of facts becomes one indented line for each.
std::string to_text(const Facts& facts);

/// JSON of several lines, with a line break at its end. Names of files that are no UTF-8 get replacement characters.
std::string to_json_text(const Facts& facts);

/// A number as JSON where JSON has it; NaN and infinity as text. No zero has a sign.
Facts number(double value);

/// How a file was made: an object.
Facts provenance_facts(const Provenance& provenance);

}  // namespace kontur::app
