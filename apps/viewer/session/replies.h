// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/stop.h"
#include "viewer/files/imports.h"
#include "viewer/session/session_state.h"

// Replies to HTTP requests, and the first message of each page. They lock the state's mutex where they need it; errors are
// exceptions.

namespace kontur::viewer {

/// What an import came to: structures, or why the contours may not belong to the image, and then nothing has changed.
struct ImportReply {
    std::vector<Id> structures;
    std::vector<std::string> doubts;
    std::vector<std::string> notes;    ///< what was left out, or had to be decided
    std::vector<TracedMask> traced{};  ///< of a preview, and nothing has changed
};

/// What is told of a surface's points besides where they are.
struct MeshExtras {
    bool widths = false;           ///< of the 90 % band there, which take longer than all the rest
    bool origins = false;          ///< who made it there, of a mask to be corrected
    std::optional<Id> far_from{};  ///< how far they are from the surface of this structure
    std::optional<int> time{};     ///< of the image, which a structure that moves is seen at; unset: the opened one
};

/// What is to be downloaded.
struct ExportChoice {
    std::string name;             ///< of a kind, as "mask.nii.gz"
    std::optional<Id> structure;  ///< unset: all
    std::optional<int> time;      ///< of the image; unset: the opened one
};

/// Two structures, at a time of the image; unset: the opened one.
struct Compared {
    Id first = 0, second = 0;
    std::optional<int> time;
};

/// A name and the bytes of a file to download.
struct Download {
    std::string file_name;
    std::string content_type;
    std::string bytes;
};

/// The `session` event for a page that has just come, with further members of whoever serves it.
std::string greeting(SessionState& s, const nlohmann::json& more);
std::string slice_reply(SessionState& s, std::string_view request);
/// Without triangles, and at the stage "none", where there is no surface: it may go while it is asked for.
/// `coded`: in few bytes, which are worth compressing.
std::string mesh_reply(const SessionState& s, Id structure, bool coded, const MeshExtras& extras);
/// These three throw StructureRemoved for a structure that another page has removed meanwhile.
/// Of structures that move, at the chosen time.
Download exported(SessionState& s, const ExportChoice& choice, const StopToken& stop);
/// Of all structures with contours, as JSON; of those that move, at the time.
std::string statistics_reply(SessionState& s, std::optional<int> time, const StopToken& stop);
/// How two structures agree, voxel by voxel, as JSON.
std::string comparison_reply(SessionState& s, const Compared& compared, const StopToken& stop);

ImportReply import(SessionState& s, const std::string& bytes, const Upload& upload, const StopToken& stop);
/// Structure sets and segmentations that lie near a DICOM image and were drawn on it, or in its frame of reference, as JSON.
std::string drawings_reply(const SessionState& s, const StopToken& stop);
/// Imports one of these. Throws Error(invalid_input) for another file, and as `import`.
ImportReply import_near(SessionState& s, const std::filesystem::path& file, const Upload& upload, const StopToken& stop);

/// One structure for each set, with the mask that its contours correct if there is one, as one step of the history. A label
/// value that another structure has is left out.
std::vector<Id> add_structures(SessionState& s, const std::string& label, const std::vector<ContourSet>& sets,
                               const LabelValues& values = {}, const ImportedMasks& masks = {});
/// A new project's first structures, before its history.
void begin_with(SessionState& s, const std::vector<ContourSet>& sets);
/// Shows it beside the project's own image, in place of the one that was; kept with the project. Throws as
/// `assumptions_of_one_space`, and then nothing changes.
void put_second_image(SessionState& s, OpenedImage opened);

}  // namespace kontur::viewer
