// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "kontur/fill_labels.h"
#include "kontur/shape/provenance.h"
#include "structures.h"

namespace kontur::app {

/// Structures of a file that a label map has no room for, as they overlap: each is filled by itself.
struct FilledStructures {
    Structures structures;
    FillReport report;  ///< of all of them, by their numbers
};

/// Fills those that `options.labels` names, or all. Throws as fill_labels does, with the structure's name in front, and
/// Error(invalid_input) for a number that none has.
FilledStructures fill_structures(const ImageInput& input, const Image* image, const FillOptions& options, const Work& work);

/// Throws Error(invalid_input) where the output has room for one of them alone, and several are to be filled.
void check_room_for_overlap(const FillCommand& command);

/// Writes a SEG, or the one structure as a label map. Returns what the user should know.
std::vector<std::string> write_filled(const OutputFile& file, const FilledStructures& filled, const Work& work);

}  // namespace kontur::app
