// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// How an output was made, as names and values in order, for the text fields of files. Neither time nor file names: the same
/// input gives the same bytes, and names of files may name patients. Names are words of letters, digits and '_'; values have
/// no line breaks.
using Provenance = std::vector<std::pair<std::string, std::string>>;

/// SHA-256 of everything drawn, as 64 hexadecimal digits: planes, points and marks, not the name. Equal contours have equal
/// digests, whatever file they come from.
std::string contours_sha256(const ContourSet& contours);

/// SHA-256 of the grid's size and affine.
std::string grid_sha256(const Grid& grid);

/// The names and values as one line of JSON, {"NAME": "VALUE", ...}.
std::string to_json(const Provenance& provenance);

/// "NAME=VALUE NAME=VALUE ..." cut to at most `most_bytes`, for fields of fixed size; digests are shortened to 12 digits.
std::string short_text(const Provenance& provenance, std::size_t most_bytes);

}  // namespace kontur
