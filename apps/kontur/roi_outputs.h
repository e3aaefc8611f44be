// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "dicom_output.h"
#include "facts.h"
#include "kontur/derive/derive.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/labels/shared_surface.h"
#include "kontur/segment_together.h"
#include "roi_drawings.h"
#include "roi_label_map.h"

namespace kontur::app {

/// What one fit leaves.
struct FittedRoi {
    DicomSegment segment;
    Roi roi;  ///< the surface on the slices, where an RTSTRUCT is asked for
    SegmentReport report;
    Provenance provenance;
    std::string rule{};  ///< of a derived structure, whose report has the mask's figures alone
};

/// What is said about the n-th structure beside its voxels.
FittedRoi fitted_roi(const RoiDrawings& drawings, std::size_t n, SegmentReport report);

/// What all fits say once, what differs with the label's number behind its name.
Provenance common_provenance(const std::vector<FittedRoi>& all);

/// What all ROIs became.
struct RoiResults {
    std::vector<FittedRoi> all{};
    std::vector<LeftOutRoi> left_out;
    RoiLabelMap labels;                       ///< unless the output has room for overlap
    Structures structures{};                  ///< where it has: a SEG or a .seg.nrrd keeps all voxels
    std::optional<SharedSurface> surface{};   ///< where a mesh is asked for
    std::optional<Together> together{};       ///< without the structures: what they are to each other
    std::vector<NamedStructure> for_rules{};  ///< where there are rules
    std::vector<std::string> notes;

    RoiResults(const SegmentCommand& command, const RoiDrawings& drawings)
        : left_out(drawings.left_out), labels(drawings.grid, command.all_rois), notes(drawings.notes) {}

    /// A structure without voxels is none of a SEG's segments, and gets the label 0 there.
    void add(const SegmentCommand& command, FittedRoi one, ContourSet outlines, Mask mask, const IndexBox& box);
};

/// Which of --all-rois are in no output, and why.
void put_left_out(const std::vector<LeftOutRoi>& left_out, Facts& report);

/// The content of --report.
Facts roi_report(const RoiResults& results, const Provenance& provenance);

std::vector<std::string> names_of(const std::vector<FittedRoi>& all);
/// What a label map calls its labels.
std::vector<LabelName> label_names(const std::vector<FittedRoi>& all);

/// Write one output and return what the user should know.
std::vector<std::string> write_label_map(const std::filesystem::path& path, const RoiResults& results,
                                         const Provenance& provenance);
std::vector<std::string> write_roi_contours(const std::filesystem::path& path, const SegmentCommand& command,
                                            const std::vector<FittedRoi>& all, const Provenance& provenance);

/// Regions are named by the structures that they belong to.
void write_roi_surfaces(const std::filesystem::path& path, const RoiResults& results, const Provenance& provenance);

}  // namespace kontur::app
