// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <memory>
#include <type_traits>

#include "commands.h"
#include "kontur/base/error.h"
#include "nearest_name.h"
#include "slicer.h"
#include "usage_sentence.h"

namespace kontur::app {
namespace {

std::string footer() {
    const auto code = [](ErrorKind kind) { return exit_code(kind); };
    return fmt::format(
        "Exit codes: 0 done, {} wrong usage, {} invalid input, {} corrupt file, {} unsupported, {} no unique solution,\n"
        "{} read or write failed, {} too large, {} interrupted (docs/command-line.md).\n"
        "Lengths are mm, volumes ml, coordinates the patient frame LPS. Research software, not a medical device.",
        kUsageExitCode, code(ErrorKind::invalid_input), code(ErrorKind::corrupt_file), code(ErrorKind::unsupported),
        code(ErrorKind::singular_system), code(ErrorKind::io), code(ErrorKind::too_large), code(ErrorKind::cancelled));
}

void add_archive_options(CLI::App& sub, ArchiveOptions& archive) {
    sub.add_option("--credentials", archive.credentials,
                   "Of an archive: file of one line, user:password or Bearer TOKEN [$KONTUR_ARCHIVE_CREDENTIALS]")
        ->type_name("FILE");
    sub.add_option("--ca", archive.ca, "Certificates (PEM) of the archive's own authority [the system's]")
        ->type_name("FILE");
    sub.add_option("--give-up-s", archive.give_up_s, "Give up an archive that sends next to nothing for so many seconds")
        ->type_name("S")
        ->capture_default_str()
        ->check(CLI::Range(1, 86400));
}

/// Adds the subcommand that runs a `Command`. Its members' values at this point are the defaults that --help shows.
template <class Command>
struct Binder {
    Binder(CLI::App& app, Invocation& its_invocation, const std::string& name, const std::string& description,
           const std::string& example)
        : invocation(its_invocation),
          sub(app.add_subcommand(name, description)),
          command(std::make_shared<Command>()),
          archive(std::make_shared<ArchiveWords>()) {
        sub->footer("Example:\n  " + example);
        sub->parse_complete_callback([&target = invocation, command = command, words = archive] {
            target.archive = words;
            target.command = [command](Console& console) { run(*command, console); };
            if constexpr (std::is_same_v<Command, SegmentCommand>) target.check = [command] { check_words(*command); };
        });
    }

    /// A required word or list of words without a flag.
    template <class Value>
    void word(const std::string& name, Value& value, const std::string& help) {
        sub->add_option(name, value, help)->required()->type_name("");
    }
    /// `unit` stands where the value goes: MM, FILE, N.
    template <class Value>
    CLI::Option* option(const std::string& name, Value& value, const std::string& unit, const std::string& help) {
        return sub->add_option(name, value, help)->type_name(unit);
    }
    /// The same with its default shown.
    template <class Value>
    CLI::Option* defaulted(const std::string& name, Value& value, const std::string& unit, const std::string& help) {
        return option(name, value, unit, help)->capture_default_str();
    }
    CLI::Option* flag(const std::string& name, bool& value, const std::string& help) {
        return sub->add_flag(name, value, help);
    }
    void quiet() { flag("--quiet", invocation.quiet, "No progress bar and no results, only warnings and errors"); }

    /// The words that may be addresses of an archive, and how it is reached.
    void addresses(std::vector<ArchiveWords::Place> places, std::vector<ArchiveWords::List> lists = {}) {
        archive->places = std::move(places);
        archive->lists = std::move(lists);
        add_archive_options(*sub, archive->options);
    }

    Invocation& invocation;
    CLI::App* sub;
    std::shared_ptr<Command> command;
    std::shared_ptr<ArchiveWords> archive;
};

/// A number of this range, which "nan" is not. What is no number at all the option's type refuses by itself.
CLI::Validator between(double least, double most) {
    return {[=](const std::string& word) {
                double value = 0;
                const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
                if (failure == std::errc::invalid_argument || (value >= least && value <= most)) return std::string();
                return fmt::format("is {}, but must be from {} to {}", word, least, most);
            },
            ""};
}

/// Of 64 bits without a sign, which the option's type by itself would read into a negative one.
CLI::Validator whole_number() {
    return {[](const std::string& word) {
                std::uint64_t value = 0;
                const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
                if (failure == std::errc() && end == word.data() + word.size()) return std::string();
                return fmt::format("is {}, but must be a whole number from 0 to {}", word,
                                   std::numeric_limits<std::uint64_t>::max());
            },
            ""};
}

CLI::Option* add_threads(CLI::App& sub, int& threads, const std::string& help = "Threads; 0: as many as the machine has") {
    constexpr double kMostThreads = 4096;
    return sub.add_option("--threads", threads, help)
        ->type_name("N")
        ->capture_default_str()
        ->check(between(0, kMostThreads));
}

template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// "" where it is none of them.
template <class Value>
std::string name_of(const Value& value, const Choices<Value>& choices) {
    for (const auto& [name, choice] : choices)
        if (choice == value) return name;
    return "";
}

/// One of several named values, shown as a|b|c.
template <class Value>
CLI::Option* add_choice(CLI::App& sub, const std::string& flag, Value& value, const Choices<Value>& choices,
                        const std::string& help) {
    std::string names;
    for (const auto& [name, choice] : choices) names += (names.empty() ? "" : "|") + name;
    const std::string default_name = name_of(value, choices);
    return sub
        .add_option_function<std::string>(
            flag,
            [&value, choices, flag, names](const std::string& word) {
                for (const auto& [name, choice] : choices)
                    if (name == word) {
                        value = choice;
                        return;
                    }
                throw CLI::ValidationError(flag, fmt::format("is {}, not {}", names, word));
            },
            help)
        ->type_name(names)
        ->default_str(default_name);
}

void add_read_options(CLI::App& sub, ReadImageOptions& read) {
    sub.add_option("--frame", read.frame, "Which frame of a 4D image, from 1")->type_name("N");
    add_choice<std::optional<NiftiTransform>>(sub, "--prefer", read.prefer,
                                              {{"qform", NiftiTransform::qform}, {"sform", NiftiTransform::sform}},
                                              "Which transform of a NIfTI file counts when its two differ");
    sub.add_flag("--allow-missing-geometry", read.allow_missing_geometry,
                 "Accept an image that does not say where it lies in the patient");
}

void add_series_options(CLI::App& sub, DicomSeriesOptions& series) {
    sub.add_option("--series", series.series_uid, "Which series of a DICOM folder")->type_name("UID");
    sub.add_option("--volume", series.volume, "Which volume of the series (time, echo), from 1")->type_name("N");
    sub.add_flag("--resample-slices", series.resample_slices, "Interpolate slices where they lie unevenly or are missing");
}

void add_curves(CLI::App& sub, std::optional<Curves>& curves) {
    const Choices<std::optional<Curves>> choices{{"spline", Curves::spline}, {"polygon", Curves::polygon}};
    add_choice(sub, "--curves", curves, choices,
               "The line between the points of 3D Slicer's curves: as it draws them, or straight")
        ->default_str(name_of({Curves::spline}, choices));
}

void add_holes(CLI::App& sub, std::optional<HoleEncoding>& holes) {
    const Choices<std::optional<HoleEncoding>> choices{
        {"keyhole", HoleEncoding::keyhole}, {"xor", HoleEncoding::exclusive}, {"nested", HoleEncoding::nested}};
    add_choice(sub, "--holes", holes, choices,
               "How an RTSTRUCT stores holes: one path with a channel, XOR contours, contours in contours")
        ->default_str(name_of({WriteRtstructOptions{}.holes}, choices));
}

void add_series_words(CLI::App& sub, SeriesWords& series) {
    constexpr double kMostNumber = std::numeric_limits<std::int32_t>::max();
    sub.add_option("--series-number", series.number, "Of DICOM output [the time of day, hhmmss]")
        ->type_name("N")
        ->check(between(1, kMostNumber));
    sub.add_option("--series-description", series.description, "Of DICOM output [kontur's, with date and structures]")
        ->type_name("TEXT");
}

void add_use_image(CLI::App& sub, UseImage& use) {
    add_choice<UseImage>(sub, "--use-image", use, {{"auto", UseImage::automatic}, {"off", UseImage::off}},
                         "Let the image tell how the surface runs between the contours: where it is shown, at contours left "
                         "out, that this helps; or never");
}

void add_segment_method(CLI::App& sub, SegmentOptions& o, int& threads) {
    constexpr double kMostMb = 1e9;
    add_choice<Kernel>(
        sub, "--kernel", o.kernel,
        {{"screened", Kernel::screened}, {"triharmonic", Kernel::triharmonic}, {"biharmonic", Kernel::biharmonic}},
        "Radial function: r^3 that goes back to a mean, r^3 or r");
    add_choice<Normals>(sub, "--normals", o.normals, {{"surface", Normals::surface}, {"in-plane", Normals::in_plane}},
                        "Direction of the surface at a contour: from all contours together, or the contour's alone");
    sub.add_option("--normal-offset-mm", o.normal_offset_mm, "Length of the normal constraints [from the contours' extent]")
        ->type_name("MM");
    add_choice<FillRule>(sub, "--fill-rule", o.fill_rule,
                         {{"even-odd", FillRule::even_odd}, {"declared", FillRule::declared}},
                         "Contours inside others: every other one is a hole, or only those declared to be one");
    add_choice<Corners>(sub, "--corners", o.corners, {{"rounded", Corners::rounded}, {"faithful", Corners::faithful}},
                        "Points at which a contour turns by 30 degrees or more: passed in a narrow bend, or followed into");
    sub.add_option("--quality", o.quality, "Fraction of each contour's points to fit, above 0 up to 1")
        ->type_name("Q")
        ->capture_default_str();
    sub.add_option("--smoothing", o.smoothing, "0 passes through every point exactly; without unit [by --normals]")
        ->type_name("S");
    add_choice<Conflicts>(
        sub, "--conflicts", o.conflicts,
        {{"reconcile", Conflicts::reconcile}, {"newest-wins", Conflicts::newest_wins}, {"exact", Conflicts::exact}},
        "Which contours yield where those of different planes contradict each other: both, the one that "
        "comes first in the file, none");
    add_choice<Solver>(sub, "--solver", o.solver,
                       {{"automatic", Solver::automatic},
                        {"iterative", Solver::iterative},
                        {"cholesky", Solver::cholesky},
                        {"dense", Solver::dense}},
                       "Linear solver; dense is LAPACK's dsysv");
    sub.add_option("--tolerance-mm", o.tolerance_mm,
                   "Largest error of the iterative solver at its constraints [from the contours' extent]")
        ->type_name("MM");
    add_choice<Voxelizer>(
        sub, "--voxelizer", o.voxelizer,
        {{"adaptive", Voxelizer::adaptive}, {"tracked", Voxelizer::tracked}, {"exhaustive", Voxelizer::exhaustive}},
        "Follow the surface from the contours, computing values where needed or at every voxel it "
        "passes; or compute all voxels");
    sub.add_option("--max-memory-mb", o.max_memory_mb,
                   "Refuse a run that would take more, with the estimate [what the machine has]")
        ->type_name("MB")
        ->check(between(0, kMostMb));
    add_threads(sub, threads);
}

/// How contours are fitted, and how the image is read that may tell how the surface runs between them.
template <class Command>
void add_fitting(CLI::App& sub, Command& command, CLI::Option* image) {
    add_segment_method(sub, command.options, command.threads);
    add_use_image(sub, command.options.use_image);
    add_read_options(sub, command.image.options);
    add_series_options(sub, command.image.options.dicom);
    for (const char* name :
         {"--use-image", "--frame", "--prefer", "--allow-missing-geometry", "--series", "--volume", "--resample-slices"})
        sub.get_option(name)->needs(image);
}

/// All options but some do not go with one.
void refuse_beside(CLI::App& sub, CLI::Option& one, const std::vector<std::string>& allowed) {
    for (CLI::Option* option : sub.get_options())
        if (option != &one && !option->get_lnames().empty() &&
            std::ranges::find(allowed, "--" + option->get_lnames().front()) == allowed.end())
            option->excludes(&one);
}

void add_cycle(CLI::App& sub, std::optional<double>& cycle) {
    sub.add_option("--cycle", cycle,
                   "Contours of several moments: the motion repeats after so many frames, or seconds [as the contours say]")
        ->type_name("T")
        ->check(CLI::PositiveNumber);
}

void add_segment(CLI::App& app, Invocation& invocation) {
    Binder<SegmentCommand> bind(app, invocation, "segment", "Contours in; mask, surface, picture and report out",
                                "kontur segment contours.json --image ct.nii.gz --output liver.nii.gz --mesh liver.stl \\\n"
                                "      --picture liver.png --report liver.json");
    SegmentCommand& c = *bind.command;
    bind.word("CONTOURS", c.contours,
              "Contours of one object: .json, .mrk.json, .vtk, .vtp or RTSTRUCT; several files are merged");
    CLI::Option* image = bind.option("--image", c.image.path, "FILE",
                                     "Image or DICOM folder: gives the mask's grid and the picture's slices");
    CLI::Option* spacing =
        bind.option("--spacing-mm", c.spacing_mm, "MM[,MM,MM]", "Without --image: size of the mask's voxels");
    spacing->delimiter(',')->allow_extra_args(false)->excludes(image);
    bind.defaulted("--margin-mm", c.margin_mm, "MM", "Without --image: space around the contours' box")->needs(spacing);
    bind.option("-o,--output", c.output, "FILE",
                "Mask to write: .nii, .nii.gz, .nrrd, .seg.nrrd, .mha, .mgz or, with a DICOM --image, .dcm (SEG)")
        ->required();
    bind.option("--rtstruct", c.rtstruct, "FILE", "Contours on the slices of a DICOM --image to write, as RTSTRUCT: .dcm");
    bind.option("--mesh", c.mesh, "FILE", "Surface to write: .stl, .ply, .obj, .vtk or .vtp, LPS mm");
    bind.option("--picture", c.picture, "FILE", "Picture to write: .png");
    bind.option("--uncertainty", c.uncertainty, "FILE",
                "Half width in mm of the 90 % band to write, for 3 planes and more: .ply, or an image at the mask's border");
    bind.option("--report", c.report, "FILE", "Report to write: .json");
    bind.option("--volumes", c.volumes, "FILE", "Volume in each frame of a 4D --image to write: .csv (docs/moving.md)");
    add_cycle(*bind.sub, c.cycle);
    bind.option("--roi", c.rois, "NAME",
                "Which structure of an RTSTRUCT, by name or number; again for more, which become the labels 1, 2, ...")
        ->allow_extra_args(false);
    bind.option("--rules", c.rules, "FILE",
                "Rules for further structures that follow from these ROIs, one a line (docs/derive.md)");
    bind.flag("--all-rois", c.all_rois, "All structures of the RTSTRUCT that have contours, in its order")
        ->excludes(bind.sub->get_option("--roi"));
    CLI::Option* together =
        bind.flag("--together", c.together,
                  "Of several structures those that exclude each other share no voxel and leave no gap where they touch");
    const auto rule = [&](const char* name, std::vector<std::string>& rules, const char* help) {
        bind.option(name, rules, "A:B", help)->allow_extra_args(false)->needs(together);
    };
    rule("--inside", c.inside, "The structure A lies in B: both have its voxels; again for more [as the fits lie]");
    rule("--may-overlap", c.may_overlap, "The structures A and B may share voxels; again for more");
    rule("--exclusive", c.exclusive, "The structures A and B share no voxel; again for more");
    add_curves(*bind.sub, c.read.curves);
    bind.option("--name", c.name, "NAME", "The structure's name [from the contours]");
    bind.defaulted("--label-value", c.label.label, "N", "Value of the voxels inside");
    add_holes(*bind.sub, c.holes);
    add_series_words(*bind.sub, c.series);
    bind.flag("--date", c.date, "Say in the outputs when they were made; without it the same input gives the same bytes");
    add_fitting(*bind.sub, c, image);
    bind.addresses({{&c.image.path, &c.image.options.dicom.series_uid}}, {{&c.contours}});
    bind.quiet();
}

/// 3D Slicer has a flag for each curve.
void add_slicer_curves(CLI::App& sub, std::vector<std::filesystem::path>& files) {
    const std::vector<std::string> curves = slicer_curve_flags();
    sub.add_option(curves[0], files, "Curves (.mrk.json); again for more")->type_name("FILE")->allow_extra_args(false);
    constexpr const char* kHidden = "";
    for (std::size_t n = 1; n < curves.size(); ++n)
        sub.add_option_function<std::string>(curves[n], [&files](const std::string& file) { files.emplace_back(file); })
            ->group(kHidden);
}

/// 3D Slicer's parser knows no hyphens in flags.
void add_slicer(CLI::App& app, Invocation& invocation) {
    Binder<SlicerCommand> bind(app, invocation, "slicer", "Work as a command-line module of 3D Slicer (docs/slicer.md)",
                               "kontur slicer --xml");
    SlicerCommand& c = *bind.command;
    bind.sub->set_version_flag("--xml", slicer_description(c), "Print the module's description");
    bind.option("--reference", c.reference, "FILE", "Image that was drawn on")->required();
    add_slicer_curves(*bind.sub, c.contours);
    add_curves(*bind.sub, c.read.curves);
    bind.option("--mask", c.output_mask, "FILE", "Label map to write");
    bind.option("--model", c.output_model, "FILE", "Surface to write");
    bind.option("--returnparameterfile", c.return_parameters, "FILE", "Values to write for 3D Slicer");
    add_segment_method(*bind.sub, c.options, c.threads);
}

void add_batch(CLI::App& app, Invocation& invocation) {
    Binder<BatchCommand> bind(app, invocation, "batch", "Segment a cohort: one case for each row of a table",
                              "kontur batch cases.csv --jobs 4 --summary summary.json");
    BatchCommand& c = *bind.command;
    bind.word("TABLE", c.table, "CSV with the columns contours, image, output and any option of segment");
    bind.defaulted("--jobs", c.jobs, "N", "Cases at a time")->check(between(1, 4096));
    CLI::Option* row = bind.option("--row", c.row, "N", "Only this row, from 1: for job arrays of a cluster");
    row->check(between(1, std::numeric_limits<int>::max()));
    CLI::Option* collect = bind.flag("--collect", c.collect, "Make nothing, only sum up what was done before");
    CLI::Option* count = bind.flag("--count", c.count, "Make nothing, only print the number of rows");
    add_threads(*bind.sub, c.threads, "Threads of a case that names none; 0: the machine's, shared by the jobs");
    bind.option("--rules", c.rules, "FILE",
                "Rules for further structures of each case that names no file of them (docs/derive.md)");
    bind.option("--journal", c.journal, "DIR", "Where to note what was done [TABLE without .csv, and .journal]");
    CLI::Option* summary = bind.option("--summary", c.summary, "FILE", "Summary to write: .json");
    count->excludes(row)->excludes(collect)->excludes(summary);
    bind.quiet();
}

void add_trace(CLI::App& app, Invocation& invocation) {
    Binder<TraceCommand> bind(app, invocation, "trace", "Cut a mask by planes into contours",
                              "kontur trace liver.nii.gz --planes planes.json --output contours.json");
    TraceCommand& c = *bind.command;
    bind.word("MASK", c.mask, "Mask or label map (NIfTI, NRRD, MetaImage, DICOM SEG)");
    CLI::App* where = bind.sub->add_option_group("Where to cut (one of these; without: the mask's own slices)");
    where->add_option("--planes", c.planes, "Contour file whose planes cut, whatever contours it holds")->type_name("FILE");
    CLI::Option* image =
        where->add_option("--image", c.image.path, "Image or DICOM folder whose slices cut")->type_name("FILE");
    where->require_option(0, 1);
    bind.option("-o,--output", c.output, "FILE",
                "Contours to write: .json, .mrk.json or, with a DICOM --image, .dcm (RTSTRUCT)")
        ->required();
    CLI::Option* name = bind.option("--name", c.name, "NAME", "The structure's name");
    add_holes(*bind.sub, c.holes);
    add_series_words(*bind.sub, c.series);
    CLI::Option* label = bind.option("--label", c.label, "N", "The label to cut; needed when there are several");
    bind.flag("--all-labels", c.all_labels, "Cut all labels, into one RTSTRUCT (.dcm)")->excludes(label)->excludes(name);
    bind.defaulted("--step-mm", c.options.step_mm, "MM", "Sampling distance on a plane; 0: half the smallest spacing");
    bind.defaulted("--tolerance-mm", c.options.tolerance_mm, "MM", "How far dropped points may lie off the contour");
    bind.defaulted("--min-area-mm2", c.options.min_area_mm2, "MM2", "Smaller contours are dropped");
    add_threads(*bind.sub, c.threads);
    add_read_options(*bind.sub, c.read);
    add_series_options(*bind.sub, c.image.options.dicom);
    for (const char* option : {"--series", "--volume", "--resample-slices"}) bind.sub->get_option(option)->needs(image);
    bind.addresses({{&c.image.path, &c.image.options.dicom.series_uid}, {&c.mask}});
    bind.quiet();
}

void add_correct(CLI::App& app, Invocation& invocation) {
    Binder<CorrectCommand> bind(app, invocation, "correct", "Correct a mask by what is drawn in some of its planes",
                                "kontur correct liver.nii.gz corrections.json --output corrected.nii.gz");
    CorrectCommand& c = *bind.command;
    bind.word(
        "MASK", c.mask.path,
        "Mask or label map (NIfTI, NRRD, MetaImage, DICOM SEG); with --image also a closed surface (STL, PLY, OBJ) or an "
        "RTSTRUCT");
    bind.word(
        "CORRECTIONS", c.corrections,
        "Closed contours replace the outline in their plane, open ones a piece of it: .json, .mrk.json or RTSTRUCT; several "
        "files are merged");
    bind.option("-o,--output", c.output, "FILE",
                "Label map to write: .nii, .nii.gz, .nrrd, .seg.nrrd, .mha, .mgz or, with --image, .dcm (SEG)")
        ->required();
    bind.option("--label", c.label, "N", "The label to correct; needed when there are several");
    bind.option("--mask-roi", c.mask_roi, "NAME", "The structure of an RTSTRUCT that is the mask");
    CLI::Option* image = bind.option("--image", c.image, "FILE",
                                     "Image that shows the object; for a SEG (.dcm) the DICOM folder that it refers to");
    add_choice<UseImage>(*bind.sub, "--use-image", c.use_image, {{"auto", UseImage::automatic}, {"off", UseImage::off}},
                         "Let the image decide how far corrections are carried: where it is shown, at planes left out, that "
                         "this helps; or never");
    bind.sub->get_option("--use-image")->needs(image);
    bind.defaulted("--reach", c.options.reach, "FACTOR", "How far a correction is carried on, from 0.25 to 4");
    bind.flag("--drop-loose", c.options.drop_loose, "Take away the pieces that a correction cuts off");
    bind.flag("--shared-borders", c.shared_borders,
              "Of a label map: where the label retreats from another one that it touched, this one follows");
    bind.option("--provenance-map", c.provenance_map, "FILE",
                "Label map to write of what made each voxel: 1 as before, 2 added and 3 removed where drawn, 4 added and 5 "
                "removed beside, 6 added and 7 removed by the image");
    bind.option("--report", c.report, "FILE", "Report to write: .json");
    bind.option("--roi", c.read.roi, "NAME", "The structure of an RTSTRUCT that holds the corrections");
    add_curves(*bind.sub, c.read.curves);
    add_series_words(*bind.sub, c.series);
    add_threads(*bind.sub, c.threads);
    add_read_options(*bind.sub, c.mask.options);
    add_series_options(*bind.sub, c.mask.options.dicom);
    bind.addresses({{&c.mask.path}, {&c.image, &c.mask.options.dicom.series_uid}}, {{&c.corrections}});
    bind.quiet();
}

void add_derive(CLI::App& app, Invocation& invocation) {
    Binder<DeriveCommand> bind(
        app, invocation, "derive", "Make structures of structures by rules (docs/derive.md)",
        "kontur derive 'PTV = CTV + 5 mm - (Cord + 3 mm)' -i plan.dcm --image ct/ --rtstruct ptv.dcm");
    DeriveCommand& c = *bind.command;
    bind.sub->add_option("RULE", c.rules, "NAME = EXPRESSION; again for more")->type_name("");
    bind.option("--rules", c.rules_file, "FILE", "More rules, one a line; # begins a comment");
    bind.option("-i,--input", c.inputs, "FILE",
                "Structures that rules name: RTSTRUCT, contours, label map or SEG; again for more")
        ->allow_extra_args(false);
    bind.option("--image", c.image.path, "FILE", "Image or DICOM folder: the grid of contours, and what body() looks at");
    bind.option("-o,--output", c.output, "FILE",
                "Label map to write: .nii, .nii.gz, .nrrd, .seg.nrrd, .mha, .mgz or, with a DICOM --image, .dcm (SEG); or "
                "contours of 1 structure (.json)");
    bind.option("--rtstruct", c.rtstruct, "FILE", "RTSTRUCT to write (.dcm), with a DICOM --image");
    bind.option("--table", c.table, "FILE",
                "Each structure against each other to write (.csv): ml, overlap, least distance, how far one sticks out");
    bind.flag("--with-sources", c.with_sources, "Write the structures that rules name, too");
    bind.option("--type", c.types, "NAME=TYPE",
                "Interpreted type of a structure in an RTSTRUCT: GTV, CTV, PTV, ORGAN, AVOIDANCE, EXTERNAL; again for more")
        ->allow_extra_args(false);
    add_holes(*bind.sub, c.holes);
    add_series_words(*bind.sub, c.series);
    add_use_image(*bind.sub, c.segment.use_image);
    add_threads(*bind.sub, c.threads);
    add_read_options(*bind.sub, c.image.options);
    add_series_options(*bind.sub, c.image.options.dicom);
    bind.addresses({{&c.image.path, &c.image.options.dicom.series_uid}}, {{&c.inputs}});
    bind.quiet();
}

/// How label maps are filled. `joint`: between the words of a flag.
void add_fill_method(CLI::App& sub, FillCommand& c, char joint) {
    const auto flag = [&](std::string_view first, std::string_view second) {
        return fmt::format("--{}{}{}", first, joint, second);
    };
    add_choice<FillEnds>(sub, "--ends", c.options.ends,
                         {{"closed", FillEnds::closed}, {"half", FillEnds::half}, {"open", FillEnds::open}},
                         "How far beyond the first and last of parallel slices: not at all, half of a gap, or as far as the "
                         "fit says");
    sub.add_option(flag("shape", "weight"), c.options.shape_weight,
                   "Share of the shape-based interpolation beside the fit, between parallel slices; 0: the fit alone")
        ->type_name("W")
        ->capture_default_str();
    sub.add_option(flag("smoothing", "voxels"), c.options.smoothing_voxels,
                   "Smoothing of the painted outlines, standard deviation")
        ->type_name("VOXELS")
        ->capture_default_str();
    add_threads(sub, c.threads);
}

void add_fill(CLI::App& app, Invocation& invocation) {
    Binder<FillCommand> bind(app, invocation, "fill", "Fill a label map between its painted slices",
                             "kontur fill sparse.nii.gz --output full.nii.gz");
    FillCommand& c = *bind.command;
    bind.word("SPARSE", c.labels.path, "Label map of which some slices are painted (NIfTI, NRRD, MetaImage, DICOM SEG)");
    bind.option("-o,--output", c.output, "FILE",
                "Label map to write: .nii, .nii.gz, .nrrd, .seg.nrrd, .mha, .mgz or, with --image, .dcm (SEG)")
        ->required();
    CLI::Option* image =
        bind.option("--image", c.image, "FILE",
                    "Image that was painted on, for --use-image, or DICOM folder that a SEG (.dcm) refers to");
    add_choice<UseImage>(
        *bind.sub, "--use-image", c.options.use_image, {{"auto", UseImage::automatic}, {"off", UseImage::off}},
        "Let the image tell how the surface runs between the slices: where it is shown, at slices left out, "
        "that this helps; or never");
    bind.sub->get_option("--use-image")->needs(image);
    bind.flag("--on-image", c.on_image, "Fill on the image's grid: each painted slice goes to its nearest slice there")
        ->needs(image);
    bind.option("--label", c.options.labels, "N", "Fill only this label; again for more [all]")->allow_extra_args(false);
    bind.sub->add_flag_callback(
        "--alone", [&c] { c.options.jointly = false; }, "Each label for itself: labels that touch are not taken together");
    add_fill_method(*bind.sub, c, '-');
    bind.option("--report", c.report, "FILE", "Report to write: .json");
    add_series_words(*bind.sub, c.series);
    add_read_options(*bind.sub, c.labels.options);
    add_series_options(*bind.sub, c.labels.options.dicom);
    bind.quiet();
}

/// As `add_slicer`; the flags are its own, since "--output" names no node of a panel.
void add_slicer_correct(CLI::App& app, Invocation& invocation) {
    Binder<SlicerCorrectCommand> bind(
        app, invocation, "slicer-correct",
        "Work as a command-line module of 3D Slicer that corrects a label map (docs/slicer.md)",
        "kontur slicer-correct --xml");
    CorrectCommand& c = bind.command->correct;
    bind.sub->set_version_flag("--xml", slicer_description(*bind.command), "Print the module's description");
    bind.option("--labels", c.mask.path, "FILE", "Label map to correct")->required();
    bind.sub
        ->add_option_function<std::int64_t>(
            "--label", [&c](std::int64_t label) { c.label = label == 0 ? std::nullopt : std::optional(label); },
            "Which label is corrected; 0: the only one")
        ->type_name("N")
        ->default_str("0");
    bind.option("--image", c.image, "FILE", "Image that was segmented");
    add_slicer_curves(*bind.sub, c.corrections);
    add_curves(*bind.sub, c.read.curves);
    add_choice<bool>(*bind.sub, "--loose", c.options.drop_loose, {{"keep", false}, {"drop", true}},
                     "What becomes of pieces that a correction cuts off");
    bind.defaulted("--reach", c.options.reach, "FACTOR", "How far a correction is carried on, from 0.25 to 4");
    bind.option("--corrected", c.output, "FILE", "Label map to write");
    add_threads(*bind.sub, c.threads);
    bind.option("--returnparameterfile", bind.command->return_parameters, "FILE", "Values to write for 3D Slicer");
}

void add_slicer_fill(CLI::App& app, Invocation& invocation) {
    Binder<SlicerFillCommand> bind(app, invocation, "slicer-fill",
                                   "Work as a command-line module of 3D Slicer that fills label maps (docs/slicer.md)",
                                   "kontur slicer-fill --xml");
    SlicerFillCommand& c = *bind.command;
    bind.sub->set_version_flag("--xml", slicer_description(c), "Print the module's description");
    bind.option("--labels", c.fill.labels.path, "FILE", "Label map of which some slices are painted")->required();
    bind.option("--image", c.fill.image, "FILE", "Image that was painted on");
    bind.option("--filled", c.fill.output, "FILE", "Label map to write");
    add_fill_method(*bind.sub, c.fill, '_');
    bind.option("--returnparameterfile", c.return_parameters, "FILE", "Values to write for 3D Slicer");
}

void add_suggest(CLI::App& app, Invocation& invocation) {
    constexpr int kMostPlanes = 1000;
    Binder<SuggestCommand> bind(app, invocation, "suggest", "Planes in which to draw next, and how sure the surface is",
                                "kontur suggest contours.json --image ct.nii.gz --planes 3 --output planes.json");
    SuggestCommand& c = *bind.command;
    bind.option("CONTOURS", c.contours, "",
                "Contours of one object: .json, .mrk.json, .vtk, .vtp or RTSTRUCT; several files are merged. With --mask: "
                "corrections drawn so far");
    CLI::Option* image = bind.option("--image", c.image.path, "FILE", "Image or DICOM folder that was drawn on");
    CLI::Option* mask = bind.option("--mask", c.mask, "FILE",
                                    "Mask or label map to be corrected: planes in which its border is unlike the image");
    mask->needs(image);
    bind.option("--label", c.label, "N", "The label of the mask; needed when there are several")->needs(mask);
    bind.defaulted("--planes", c.planes, "N", "How many")->check(between(1, kMostPlanes));
    bind.defaulted("--skip", c.skip, "N", "Pass over the N best ones, and what runs along them")
        ->check(between(0, kMostPlanes));
    bind.option("--empty-planes", c.empty_planes, "FILE",
                "Planes that show nothing of the object, as --output writes them; besides those of CONTOURS: .json");
    add_cycle(*bind.sub, c.cycle);
    add_choice<PlaneChoice>(*bind.sub, "--among", c.among,
                            {{"any", PlaneChoice::any}, {"image-slices", PlaneChoice::image_slices}},
                            "Planes of any direction, or only slices across the axes of the image");
    bind.option("-o,--output", c.output, "FILE", "Planes to write, for --planes of trace: .json");
    bind.option("--sketch", c.sketch, "FILE", "Contours to write: the outlines predicted in the planes: .json");
    bind.option("--roi", c.read.roi, "NAME", "Which structure of an RTSTRUCT, by name or number");
    add_curves(*bind.sub, c.read.curves);
    bind.flag("--json", c.json, "Print JSON");
    add_fitting(*bind.sub, c, image);
    refuse_beside(*bind.sub, *mask,
                  {"--among", "--curves", "--empty-planes", "--frame", "--json", "--label", "--output", "--planes", "--roi",
                   "--sketch", "--skip", "--threads", "--allow-missing-geometry", "--prefer", "--resample-slices",
                   "--series", "--volume", "--image", "--help"});
    bind.sub->final_callback([&c] {
        if (c.contours.empty() && c.mask.empty()) throw CLI::RequiredError("CONTOURS");
    });
    bind.addresses({{&c.image.path, &c.image.options.dicom.series_uid}, {&c.mask}}, {{&c.contours}});
    bind.quiet();
}

void add_compare(CLI::App& app, Invocation& invocation) {
    constexpr int kMostDifferences = 100'000;  // lines that somebody may want
    Binder<CompareCommand> bind(app, invocation, "compare",
                                "Overlap, surface distances in mm and volumes in ml of two masks",
                                "kontur compare liver.nii.gz truth.nii.gz --json");
    CompareCommand& c = *bind.command;
    bind.word("A", c.a, "Mask or label map (NIfTI, NRRD, MetaImage, DICOM SEG)");
    bind.word("B", c.b, "Another one on the same grid");
    bind.option("--label", c.label, "N", "The label to compare; needed when there are several");
    bind.option("--label-b", c.label_b, "N", "That of B, where it is another one [--label]");
    bind.defaulted("--differences", c.differences, "N", "Places to list where one mask is and the other not, worst first")
        ->check(between(0, kMostDifferences));
    bind.flag("--json", c.json, "Print JSON");
    add_threads(*bind.sub, c.threads);
    add_read_options(*bind.sub, c.read);
    bind.option("--frame-b", c.frame_b, "N", "That of B, where it is another one [--frame]");
}

void add_inspect(CLI::App& app, Invocation& invocation) {
    Binder<InspectCommand> bind(app, invocation, "inspect",
                                "What files are: geometry in mm, labels in ml, contours, problems found",
                                "kontur inspect ct.nii.gz contours.json liver.stl dicom_folder/");
    InspectCommand& c = *bind.command;
    bind.word("FILE", c.files, "Images, DICOM folders, contours, structure sets, meshes");
    bind.flag("--check", c.check, "List everything wrong or doubtful in contours, with its place; each file by itself");
    bind.flag("--json", c.json, "Print JSON");
    bind.addresses({}, {{&c.files, &c.read.dicom.series_uid}});
    add_read_options(*bind.sub, c.read);
    add_series_options(*bind.sub, c.read.dicom);
}

void add_convert(CLI::App& app, Invocation& invocation) {
    Binder<ConvertCommand> bind(app, invocation, "convert", "Write the same content in another format",
                                "kontur convert dicom_folder/ ct.nii.gz");
    ConvertCommand& c = *bind.command;
    bind.word("IN", c.input.path, "Image, DICOM folder, contours, structure set or mesh");
    bind.word("OUT", c.output, "File to write; its name decides the format");
    bind.option(
        "--image", c.image, "FILE",
        "DICOM folder that an RTSTRUCT or SEG (.dcm) refers to; or image whose grid a label map or a mesh's mask gets");
    bind.option("--roi", c.contours.roi, "NAME", "Which structure of a structure set, by name or number");
    add_curves(*bind.sub, c.contours.curves);
    bind.option("--label", c.label, "N", "Of a label map or segmentation only this label");
    bind.option("--add", c.more, "MASK", "One more mask for a SEG, as a segment that may overlap others; again for more")
        ->allow_extra_args(false);
    add_holes(*bind.sub, c.holes);
    add_series_words(*bind.sub, c.series);
    add_read_options(*bind.sub, c.input.options);
    add_series_options(*bind.sub, c.input.options.dicom);
    bind.addresses({{&c.input.path, &c.input.options.dicom.series_uid}, {&c.image, &c.input.options.dicom.series_uid}});
    bind.quiet();
}

void add_phantom(CLI::App& app, Invocation& invocation) {
    Binder<PhantomCommand> bind(app, invocation, "phantom", "Make a synthetic CT with exact truth masks and contours",
                                "kontur phantom demo/");
    PhantomCommand& c = *bind.command;
    bind.word("DIR", c.folder, "Folder to write to; it is made if it is not there");
    bind.option("--scan", c.scans, "NAME", "Write only this scan, such as liver; again for more [all]")
        ->allow_extra_args(false);
    bind.defaulted("--noise-hu", c.options.noise_hu, "HU", "Standard deviation of the image noise");
    bind.defaulted("--seed", c.options.seed, "N", "Of the noise")->check(whole_number());
    add_threads(*bind.sub, c.threads);
    bind.quiet();
}

void add_find(CLI::App& app, Invocation& invocation) {
    Binder<FindCommand> bind(app, invocation, "find", "List studies, series or objects of an archive (DICOMweb)",
                             "kontur find https://archive.example/dicom-web --name Doe --modality CT");
    FindCommand& c = *bind.command;
    bind.word("ADDRESS", c.address,
              "The service, which lists studies; with /studies/UID its series, /series/UID its objects");
    bind.option("--name", c.filter.name, "NAME",
                "The patient's name begins so, family name first; * and ? stand for others");
    bind.option("--id", c.filter.patient_id, "ID", "The patient's number; * and ? stand for others");
    bind.option("--date", c.filter.date, "DATE", "Of the study: YYYY-MM-DD, FROM..TO, FROM.. or ..TO");
    bind.option("--modality", c.filter.modality, "NAME", "The study has a series of it: CT, MR, PT, SEG, RTSTRUCT, ...");
    bind.defaulted("--most", c.filter.most, "N", "Studies to list")->check(between(1, 10000));
    bind.flag("--json", c.json, "Print JSON");
    add_archive_options(*bind.sub, c.access);
}

void add_fetch(CLI::App& app, Invocation& invocation) {
    Binder<FetchCommand> bind(app, invocation, "fetch", "Fetch a study, a series or an object from an archive (DICOMweb)",
                              "kontur fetch https://archive.example/dicom-web/studies/1.2.3 --output study/");
    FetchCommand& c = *bind.command;
    bind.word("ADDRESS", c.address, "SERVICE/studies/UID; with /series/UID one series, and /instances/UID one object");
    bind.option("-o,--output", c.output, "DIR",
                "Folder to make: for a study with a folder for each series; for an object the file (.dcm)")
        ->required();
    bind.option("--modality", c.modality, "NAME", "Of a study only series of it");
    add_archive_options(*bind.sub, c.access);
    bind.quiet();
}

void add_send(CLI::App& app, Invocation& invocation) {
    Binder<SendCommand> bind(app, invocation, "send", "Store DICOM files in the archive that has their study (DICOMweb)",
                             "kontur send seg.dcm contours.dcm --archive https://archive.example/dicom-web");
    SendCommand& c = *bind.command;
    bind.word("FILES", c.files, "DICOM files, such as a SEG and an RTSTRUCT; what the archive has already is left as it is");
    bind.option("--archive", c.address, "ADDRESS", "The service")->required();
    add_archive_options(*bind.sub, c.access);
    bind.quiet();
}

/// Shown beside the image of `kontur open`.
void add_second_image(CLI::App& sub, ImageInput& second) {
    CLI::Option* image =
        sub.add_option("--second-image", second.path,
                       "Image or DICOM folder to show over the first, as a PET over its CT; kept in the project");
    image->type_name("FILE");
    ReadImageOptions& options = second.options;
    sub.add_option("--second-series", options.dicom.series_uid, "Which series of the second image's folder")
        ->type_name("UID");
    sub.add_option("--second-volume", options.dicom.volume, "Which volume of that series, from 1")->type_name("N");
    sub.add_option("--second-frame", options.frame, "Which frame of a 4D second image, from 1")->type_name("N");
    for (const char* name : {"--second-series", "--second-volume", "--second-frame"}) sub.get_option(name)->needs(image);
}

void add_open(CLI::App& app, Invocation& invocation) {
    Binder<OpenCommand> bind(app, invocation, "open", "Draw and see the surface follow, in the browser",
                             "kontur open ct.nii.gz contours.json");
    OpenCommand& c = *bind.command;
    bind.sub
        ->add_option(
            "FILES", c.files,
            "An image or DICOM folder, contours, a project (.kontur), or phantom, the example; nothing: choose in the page")
        ->type_name("");
    bind.option("--project", c.project, "FILE",
                "Project to keep the work in [beside the contours, else in your data folder]");
    bind.option("--roi", c.read.roi, "NAME", "Which structure of an RTSTRUCT, by name or number");
    add_curves(*bind.sub, c.read.curves);
    bind.defaulted("--port", c.server.port, "N", "Port on 127.0.0.1; 0: any free one")
        ->check(between(0, std::numeric_limits<std::uint16_t>::max()));
    bind.option("--token", c.server.token, "TEXT", "Secret of the address [random]");
    bind.defaulted("--timeout", c.server.idle_timeout_s, "S", "End after so many seconds without an open page; 0: never")
        ->check(between(0, std::numeric_limits<int>::max()));
    bind.flag("--no-browser", c.no_browser, "Only print the address");
    add_read_options(*bind.sub, c.image.options);
    add_series_options(*bind.sub, c.image.options.dicom);
    bind.addresses({{&c.second_image.path, &c.second_image.options.dicom.series_uid}},
                   {{&c.files, &c.image.options.dicom.series_uid}});
    bind.archive->with_drawings = true;
    bind.option("--archive", c.archive_address, "ADDRESS", "DICOMweb service whose studies the page lists")
        ->each([words = bind.archive.get()](const std::string&) { words->is_for_page = true; });
    c.archive_options = &bind.archive->options;
    add_second_image(*bind.sub, c.second_image);
}

/// All commands.
std::vector<std::string> names_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) names.push_back(sub->get_name());
    return names;
}

/// "; did you mean NAME?", or "" where no name is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
    const std::string nearest = nearest_name(word, names);
    return nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest);
}

std::vector<std::string> long_options_of(const CLI::App& sub) {
    std::vector<std::string> names;
    for (const CLI::Option* option : sub.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const CLI::App* group : sub.get_subcommands([](const CLI::App* app) { return app->get_name().empty(); }))
        for (std::string& name : long_options_of(*group)) names.push_back(std::move(name));
    return names;
}

/// Of the first long option that the command does not have; "" without one. The parser by itself would first miss what is
/// required, such as --output where it reads --ouput.
std::string unknown_option(const std::vector<std::string>& names, const std::vector<std::string>& words) {
    if (names.empty()) return "";
    for (std::size_t n = 1; n < words.size() && words[n] != "--"; ++n) {
        const std::string name = words[n].substr(0, words[n].find('='));
        if (name.starts_with("--") && std::ranges::find(names, name) == names.end())
            return fmt::format("there is no option {}{}", name, suggestion(name, names));
    }
    return "";
}

}  // namespace

std::vector<OptionName> options_of_segment() {
    CLI::App app;
    Invocation invocation;
    add_segment(app, invocation);
    const CLI::App* segment = app.get_subcommand("segment");
    std::vector<OptionName> options;
    for (const CLI::Option* option : segment->get_options())
        if (option != segment->get_help_ptr())
            for (const std::string& name : option->get_lnames()) options.push_back({name, option->get_expected_max() == 0});
    return options;
}

Invocation parse_command_line(int argc, const char* const* argv) {
    Invocation invocation;
    CLI::App app("kontur: smooth 3D organs from a few hand-drawn contours", "kontur");
    app.set_version_flag("--version", "kontur " KONTUR_VERSION, "Print the version");
    app.footer(footer());
    app.require_subcommand(0, 1);
    app.get_formatter()->column_width(36);
    add_segment(app, invocation);
    add_slicer(app, invocation);
    add_batch(app, invocation);
    add_trace(app, invocation);
    add_correct(app, invocation);
    add_derive(app, invocation);
    add_fill(app, invocation);
    add_slicer_fill(app, invocation);
    add_slicer_correct(app, invocation);
    add_suggest(app, invocation);
    add_compare(app, invocation);
    add_inspect(app, invocation);
    add_convert(app, invocation);
    add_phantom(app, invocation);
    add_find(app, invocation);
    add_fetch(app, invocation);
    add_send(app, invocation);
    add_open(app, invocation);

    std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    if (!words.empty() && (words[0] == "help" || words[0] == "-h" || words[0] == "--help")) {
        words.erase(words.begin());  // of the command that follows, if one does
        words.insert(words.begin() + std::min<std::ptrdiff_t>(1, std::ssize(words)), "--help");
    }
    const std::vector<std::string> names = names_of(app);
    if (!words.empty() && !words[0].starts_with('-') && std::find(names.begin(), names.end(), words[0]) == names.end()) {
        invocation.text = fmt::format("there is no command '{}'; there are {}{}", words[0], fmt::join(names, ", "),
                                      suggestion(words[0], names));
        invocation.exit_code = kUsageExitCode;
        return invocation;
    }
    if (!words.empty() && !words[0].starts_with('-')) invocation.options = long_options_of(*app.get_subcommand(words[0]));
    if (invocation.text = unknown_option(invocation.options, words); !invocation.text.empty()) {
        invocation.exit_code = kUsageExitCode;
        return invocation;
    }
    std::reverse(words.begin(), words.end());  // as the parser wants them
    try {
        app.parse(std::move(words));
    } catch (const CLI::CallForHelp&) {
        invocation.text = app.help();  // of the subcommand when there is one
        invocation.command = nullptr;
        return invocation;
    } catch (const CLI::CallForVersion& version) {
        invocation.text = std::string(version.what()) + "\n";
        return invocation;
    } catch (const CLI::ParseError& error) {
        invocation.text = usage_sentence(error.what());
        invocation.exit_code = kUsageExitCode;
        invocation.command = nullptr;
        return invocation;
    }
    if (!invocation.command) invocation.text = app.help();
    return invocation;
}

}  // namespace kontur::app
