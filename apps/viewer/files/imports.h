// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/contour.h"
#include "viewer/model/stored_mask.h"

namespace kontur::viewer {

/// What the names of files end with that can be imported, longer ones first; pages are told these lists. Formats in two
/// files
/// (.hdr with .img, .mhd, .nhdr) are not among them, for an upload is one, nor is GIPL, which never says how it lies in the
/// patient.
inline constexpr std::array kContourEndings{".mrk.json", ".json", ".dcm", ".vtk", ".vtp"};
inline constexpr std::array kMaskEndings{".nii.gz", ".nii", ".seg.nrrd", ".nrrd", ".mha", ".mgh.gz", ".mgh", ".mgz"};

/// Where a mask is cut into contours.
struct TraceRequest {
    int planes = 9;  ///< along each axis
    bool axial = true, sagittal = true, coronal = true;
    bool preview = false;  ///< nothing comes in, and `ImportContent::traced` says what the planes keep
};

/// A file that a page has sent.
struct Upload {
    enum class Content { contours, mask };
    /// What becomes of masks, and of contours that fill their slices.
    enum class Purpose {
        contours,  ///< masks are traced
        correct,   ///< a mask that contours correct
    };
    Content content = Content::contours;
    std::string extension{};  ///< one that kontur knows
    TraceRequest trace{};     ///< of a mask or segmentation
    bool anyway = false;      ///< whether it comes in though it may not belong to the image
    std::string file{};       ///< its name, for what has none of its own; nothing is opened by it
    Purpose purpose = Purpose::contours;
    std::string images{};      ///< folder or file of DICOM images in time, which a structure set may say frames of; "" else
    std::string series_uid{};  ///< of those that are opened
};

/// Of structures that were labels of a map, by their place in the list.
using LabelValues = std::map<std::size_t, std::int64_t>;

/// A mask to be corrected.
struct ImportedMask {
    std::shared_ptr<const StoredMask> mask;
    std::string source{};  ///< what made it, as its file says; "" where that says nothing
};
/// Of structures that are such masks, by their place in the list.
using ImportedMasks = std::map<std::size_t, ImportedMask>;

/// What the contours of a mask make of it again.
struct TracedMask {
    std::string name;
    double volume_ml = 0, traced_ml = 0;  ///< of the mask, and of what the contours make
    double dice = 0;                      ///< of the two
};

struct ImportContent {
    std::vector<ContourSet> sets;          ///< one for each structure of the file; empty where it is a mask to be corrected
    std::vector<std::string> notes;        ///< how the file was read, for the user to see
    std::string frame_of_reference_uid{};  ///< "" when none is named
    std::string patient{};                 ///< whom a DICOM file is of, for people; "" where it does not say
    LabelValues label_values{};            ///< of those sets that had one
    std::vector<TracedMask> traced{};      ///< of a preview; there are no sets then
    ImportedMasks masks{};
};

/// What the file holds, read by this program in a process of its own, with limits on memory and time: a file that crashes a
/// reader, or makes it grow or run on, costs the import and nothing else. Throws the reader's error, and Error(corrupt_file)
/// or Error(too_large) when that process ends otherwise; Error(cancelled) ends it at once.
ImportContent import_apart(const std::string& bytes, const Upload& upload, const Work& work = {});

/// The word that makes this program that process; for `main`, before it reads its command line.
inline constexpr const char* kImportWorker = "--import-worker";
int import_worker(int argc, char** argv);

}  // namespace kontur::viewer
