// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/provenance.h"

namespace kontur {

/// Reads kontur's own contour file (docs/formats.md, docs/contours.schema.json). Frames "LPS mm" and "RAS mm"; the axes of
/// a plane are made orthonormal, because files round them; a closed contour's last point that repeats the first is dropped.
/// Whether the contours can be segmented is for `check_contours`. Throws Error(corrupt_file) naming file, plane, contour and
/// point (each counted from 1, contours within their plane), Error(unsupported) for another frame or a newer version.
ContourSet read_contour_json(const std::filesystem::path& path);
/// The same from the text of such a file.
ContourSet parse_contour_json(std::string_view text);

/// The planes of such a file, in its order, with or without contours.
std::vector<Plane> read_planes_json(const std::filesystem::path& path);
std::vector<Plane> parse_planes_json(std::string_view text);

/// The planes under "confirmed_planes", which were looked at and in which an existing mask is right; most files have none.
std::vector<Plane> read_confirmed_planes_json(const std::filesystem::path& path);
std::vector<Plane> parse_confirmed_planes_json(std::string_view text);

/// Writes planes without contours, in the same format, whole or not at all. Throws as write_contour_json does.
void write_planes_json(const std::filesystem::path& path, const std::vector<Plane>& planes, const std::string& name = {});

/// Writes the file whole or not at all. Reading it gives the same doubles in the same order; neighbouring contours on an
/// identical plane share one entry. `provenance` goes into the key of that name. Throws Error(invalid_input) for a
/// coordinate that is NaN or infinite and a name that is no UTF-8.
void write_contour_json(const std::filesystem::path& path, const ContourSet& set, const Provenance& provenance = {});
/// The text of that file.
std::string to_contour_json(const ContourSet& set, const Provenance& provenance = {});

/// The same with planes under "confirmed_planes".
void write_corrections_json(const std::filesystem::path& path, const ContourSet& set, const std::vector<Plane>& confirmed,
                            const Provenance& provenance = {});

}  // namespace kontur
