// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "commands.h"
#include "kontur/correct_mask.h"
#include "structures.h"

namespace kontur::app {

/// The image of a command, read as its mask is, but for a frame that is chosen of that.
ImageInput image_of(const CorrectCommand& command, Console& console);

/// A mask to be corrected, and what else its file holds.
struct MaskFile {
    Mask mask;
    std::int64_t label = 1;
    Image labels{};           ///< of a label map
    Structures structures{};  ///< of other files: segments that may overlap, or what a surface or contours enclose
    std::size_t chosen = 0;   ///< of these
};

/// Reads a label map; of segments that may overlap the one with --label; the inside of a closed surface, or what contours
/// enclose in each slice, at the voxels of --image. Throws Error(invalid_input) for contours that leave slices between them
/// empty, and what the readers throw.
MaskFile read_mask_file(const CorrectCommand& command, Console& console, const Work& work);

/// What was drawn; in kontur's own files with the planes that were found right.
struct ReadCorrections {
    Corrections corrections;
    std::vector<std::string> notes;
};
ReadCorrections read_corrections(const std::vector<std::filesystem::path>& paths, const ReadContoursOptions& options);

/// Puts the corrected voxels in; all others keep their values. With `shared_borders`, voxels that the label of a map loses
/// go to the label that it touched there. One sentence for each label that loses or gets some.
std::vector<std::string> put(MaskFile& file, const CorrectedMask& corrected, bool shared_borders, const Work& work);

/// A mask's file with the corrected mask in it.
struct CorrectedFile {
    MaskFile file;
    CorrectedMask corrected;
    std::vector<std::string> notes;     ///< on the corrections as they were read
    std::vector<std::string> warnings;  ///< of all kinds
    Provenance provenance;
};
CorrectedFile correct_file(const CorrectCommand& command, Console& console, const Work& work);

/// Writes the file with the corrected mask in the format of the name. A SEG says that the segment was made
/// SEMIAUTOMATIC, by its source and kontur. Returns what the user should know.
std::vector<std::string> write_mask_file(const std::filesystem::path& path, const MaskFile& file,
                                         const CorrectCommand& command, const Provenance& provenance, Console& console);

}  // namespace kontur::app
