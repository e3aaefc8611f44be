// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "archive/query.h"
#include "archive_words.h"
#include "console.h"
#include "dicom_output.h"
#include "files.h"
#include "kontur/correct_mask.h"
#include "kontur/extract/trace.h"
#include "kontur/fill_labels.h"
#include "kontur/io/contours.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/image.h"
#include "kontur/measure/compare.h"
#include "kontur/measure/differences.h"
#include "kontur/phantom/phantom.h"
#include "kontur/segment.h"
#include "kontur/sureness/candidate_planes.h"
#include "viewer/server/server_options.h"

// One struct for each command, with its words and options and their defaults, and the function that runs it: it reads, calls
// the library and writes. What it writes appears whole or not at all. All of them throw kontur::Error.

namespace kontur::app {

/// The main job: contours in, mask, surface, picture and report out.
struct SegmentCommand {
    std::vector<std::filesystem::path> contours;
    std::vector<std::string> rois;  ///< several: each becomes a label of its own
    bool all_rois = false;          ///< all that have contours take the place of `rois`
    std::filesystem::path rules;    ///< of structures that follow from these; empty: none
    bool together = false;          ///< ROIs that exclude each other share no voxel and leave no gap
    std::vector<std::string> inside, may_overlap, exclusive;  ///< rules for pairs of them: "NAME:NAME"
    ReadContoursOptions read;                                 ///< its `roi` is the only one of `rois`
    ImageInput image;                                         ///< its path is empty when `spacing_mm` gives the grid
    std::vector<double> spacing_mm;                           ///< one number or three
    double margin_mm = 10;                                    ///< around the contours' box, with `spacing_mm`
    std::filesystem::path output;
    std::filesystem::path rtstruct, mesh, picture, report;  ///< empty: not asked for
    std::filesystem::path uncertainty;                      ///< half widths of the band, as image or .ply; likewise
    std::filesystem::path volumes;                          ///< of contours drawn at several moments: .csv; likewise
    std::optional<double> cycle;                            ///< after which their motion repeats, in their unit
    LabelName label;                                        ///< of the voxels inside
    std::string name;                                       ///< of the structure; empty: the contour file's
    std::optional<HoleEncoding> holes;                      ///< of an RTSTRUCT; nullopt: as its writer does by itself
    SeriesWords series;
    bool date = false;  ///< say in the outputs when they were made
    SegmentOptions options;
    int threads = 0;  ///< 0: the machine's
};
void run(const SegmentCommand& command, Console& console);
/// What can be refused by the words alone, without a look at any file.
void check_words(const SegmentCommand& command);

/// 3D Slicer's command-line module: speaks its language on stdout, with the file names that it passes.
struct SlicerCommand {
    std::filesystem::path reference;
    std::vector<std::filesystem::path> contours;
    ReadContoursOptions read;
    std::filesystem::path output_mask, output_model;  ///< empty: not asked for
    std::filesystem::path return_parameters;          ///< where 3D Slicer looks for values to show; empty: nowhere
    SegmentOptions options;
    int threads = 0;  ///< 0: the machine's
};
void run(const SlicerCommand& command, Console& console);

/// A cohort: one call of segment for each row of a table, each in a process of its own.
struct BatchCommand {
    std::filesystem::path table;
    int jobs = 1;                   ///< at a time
    int row = 0;                    ///< only this one, from 1; 0: all
    bool collect = false;           ///< only sum up what was done before
    bool count = false;             ///< only say how many rows there are
    int threads = 0;                ///< of each case that names none; 0: the machine's, shared by the jobs
    std::filesystem::path journal;  ///< folder; empty: beside the table
    std::filesystem::path summary;  ///< empty: not asked for
    std::filesystem::path rules;    ///< for each case that names none; empty: none
};
void run(const BatchCommand& command, Console& console);

/// Ends a command that has left results behind, unlike an Error: some cases failed, or it was interrupted.
struct EndedEarly : std::runtime_error {
    EndedEarly(const std::string& sentence, int its_exit_code) : std::runtime_error(sentence), exit_code(its_exit_code) {}
    int exit_code;
};

/// Cuts a mask by planes into contours.
struct TraceCommand {
    std::filesystem::path mask;
    std::optional<std::int64_t> label;
    bool all_labels = false;  ///< each becomes a ROI of an RTSTRUCT
    ReadImageOptions read;
    std::filesystem::path planes;  ///< empty: the slices of `image` cut; without one the mask's own
    ImageInput image;
    std::filesystem::path output;
    std::string name;                   ///< of the structure; empty: the mask file's
    std::optional<HoleEncoding> holes;  ///< of an RTSTRUCT; nullopt: as its writer does by itself
    SeriesWords series;
    TraceOptions options;
    int threads = 0;  ///< 0: the machine's
};
void run(const TraceCommand& command, Console& console);

/// Corrects a mask by what was drawn in some planes.
struct CorrectCommand {
    ImageInput mask;
    std::optional<std::int64_t> label;
    std::vector<std::filesystem::path> corrections;
    ReadContoursOptions read;
    std::optional<std::string> mask_roi;  ///< of an RTSTRUCT that holds the mask
    std::filesystem::path image;          ///< that shows the object, and what a SEG refers to; empty: none
    UseImage use_image = UseImage::automatic;
    std::filesystem::path output, report, provenance_map;
    SeriesWords series;
    CorrectOptions options;
    bool shared_borders = false;  ///< labels beside the corrected one follow it where it retreats
    int threads = 0;              ///< 0: the machine's
};
void run(const CorrectCommand& command, Console& console);

/// The same as a command-line module of 3D Slicer.
struct SlicerCorrectCommand {
    CorrectCommand correct;
    std::filesystem::path return_parameters;  ///< as SlicerCommand's
};
void run(const SlicerCorrectCommand& command, Console& console);

/// Makes structures of structures by rules.
struct DeriveCommand {
    std::vector<std::string> rules;
    std::filesystem::path rules_file;               ///< more of them, one a line; empty: none
    std::vector<std::filesystem::path> inputs;      ///< RTSTRUCT, contours, label maps
    ImageInput image;                               ///< what was drawn on, and what DICOM output refers to
    std::filesystem::path output, rtstruct, table;  ///< empty: not asked for
    bool with_sources = false;                      ///< write those, too
    std::vector<std::string> types;                 ///< "NAME=TYPE" of an RTSTRUCT
    std::optional<HoleEncoding> holes;              ///< of an RTSTRUCT; nullopt: as its writer does by itself
    SeriesWords series;
    SegmentOptions segment;  ///< of structures that are contours
    int threads = 0;         ///< 0: the machine's
};
void run(const DeriveCommand& command, Console& console);

/// Fills what was left out between the painted slices of a label map.
struct FillCommand {
    ImageInput labels;
    std::filesystem::path image;  ///< what a SEG refers to, and what was painted on; empty: not needed
    bool on_image = false;        ///< its grid is filled, not the one that was painted
    std::filesystem::path output, report;
    SeriesWords series;
    FillOptions options;
    int threads = 0;  ///< 0: the machine's
};
void run(const FillCommand& command, Console& console);

/// The same as a command-line module of 3D Slicer.
struct SlicerFillCommand {
    FillCommand fill;
    std::filesystem::path return_parameters;  ///< as SlicerCommand's
};
void run(const SlicerFillCommand& command, Console& console);

/// Where to draw next.
struct SuggestCommand {
    std::vector<std::filesystem::path> contours;
    ReadContoursOptions read;
    ImageInput image;                    ///< its path is empty when there is none
    int planes = 1;                      ///< how many
    int skip = 0;                        ///< best ones passed over
    std::filesystem::path empty_planes;  ///< in which nothing of the object is seen; empty: not given
    PlaneChoice among = PlaneChoice::any;
    std::filesystem::path mask;            ///< of others, of which planes are to be looked at; empty: contours are fitted
    std::optional<std::int64_t> label;     ///< of it
    std::optional<double> cycle;           ///< of contours of several moments: how soon the motion repeats
    std::filesystem::path output, sketch;  ///< planes; predicted outlines in them; empty: not asked for
    bool json = false;
    SegmentOptions options;
    int threads = 0;  ///< 0: the machine's
};
void run(const SuggestCommand& command, Console& console);

/// A synthetic CT with exact truth masks and contours drawn on them.
struct PhantomCommand {
    std::filesystem::path folder;
    std::vector<std::string> scans;  ///< names; empty: all
    PhantomOptions options;
    int threads = 0;  ///< 0: the machine's
};
void run(const PhantomCommand& command, Console& console);

/// How alike two masks on one grid are.
struct CompareCommand {
    std::filesystem::path a, b;
    std::optional<std::int64_t> label;
    ReadImageOptions read;
    std::optional<std::int64_t> label_b, frame_b;  ///< where b's are others
    int differences = 0;                           ///< places to list, the farthest first
    bool json = false;
    int threads = 0;  ///< 0: the machine's
};
void run(const CompareCommand& command, Console& console);

/// What files are, and what is wrong with them.
struct InspectCommand {
    std::vector<std::filesystem::path> files;
    bool check = false;  ///< list what is wrong or doubtful in contour sets
    ReadImageOptions read;
    bool json = false;
};
void run(const InspectCommand& command, Console& console);

/// The same content in another format.
struct ConvertCommand {
    ImageInput input;
    std::vector<std::filesystem::path> more;  ///< masks that become further segments of a DICOM SEG
    std::optional<std::int64_t> label;        ///< of a label map or segmentation only this one
    ReadContoursOptions contours;
    std::filesystem::path image;  ///< DICOM series that DICOM output refers to; of other label maps the grid to write
    std::filesystem::path output;
    std::optional<HoleEncoding> holes;  ///< of an RTSTRUCT; nullopt: as its writer does by itself
    SeriesWords series;
};
void run(const ConvertCommand& command, Console& console);

/// What an archive has: its studies, the series of one, the objects of a series.
struct FindCommand {
    std::string address;
    archive::StudyFilter filter;
    bool json = false;
    ArchiveOptions access;
};
void run(const FindCommand& command, Console& console);

/// From an archive onto the disk.
struct FetchCommand {
    std::string address;           ///< of a study, a series or an object
    std::filesystem::path output;  ///< a folder; of an object a file
    std::string modality;          ///< of a study only these series; empty: all
    ArchiveOptions access;
};
void run(const FetchCommand& command, Console& console);

/// Results into the archive that has their study.
struct SendCommand {
    std::vector<std::filesystem::path> files;
    std::string address;  ///< of the service
    ArchiveOptions access;
};
void run(const SendCommand& command, Console& console);

/// The application in the browser.
struct OpenCommand {
    std::vector<std::filesystem::path> files;  ///< an image, contours, a project; none: the page chooses
    ImageInput image;                          ///< how to read it; the path comes from `files`
    ImageInput second_image;                   ///< shown beside it; without a path the one that the project keeps
    ReadContoursOptions read;
    std::filesystem::path project;  ///< empty: the one among `files`, beside the contours, or in the user's data folder
    viewer::ServerOptions server;
    bool no_browser = false;
    std::string archive_address;                      ///< that pages may reach; empty: none
    const ArchiveOptions* archive_options = nullptr;  ///< how
};
void run(const OpenCommand& command, Console& console);

}  // namespace kontur::app
