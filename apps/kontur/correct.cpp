// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.h"
#include "contour_files.h"
#include "dicom_output.h"
#include "drawn_on.h"
#include "facts.h"
#include "input_digests.h"
#include "kontur/base/error.h"
#include "kontur/correct_mask.h"
#include "kontur/image/intensities.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/contours/contour_json.h"
#include "mask_file.h"
#include "outputs.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_for_labels_alone(std::string_view option, const fs::path& mask) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{} is for label maps, and {} is none; leave it out", option, mask.string()));
}

/// What needs an image, or does not go with one.
void check_image_needed(const CorrectCommand& command) {
    const FileKind kind = input_kind(command.mask.path);
    if (kind != FileKind::image && command.image.empty())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} holds {}, which has no voxels; give the image that shows it with --image",
                                command.mask.path.string(), kind == FileKind::mesh ? "a surface" : "contours"));
    if (kind != FileKind::image && command.label) refuse_for_labels_alone("--label", command.mask.path);
    if (kind != FileKind::image && command.shared_borders) refuse_for_labels_alone("--shared-borders", command.mask.path);
    if (kind != FileKind::contours && command.mask_roi)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("--mask-roi is for an RTSTRUCT, and {} is none; leave it out", command.mask.path.string()));
    if (command.image.empty() && command.use_image == UseImage::off)
        throw Error(ErrorKind::invalid_input, "--use-image is for an --image, and none is given; leave it out");
}

/// Whatever can be refused before any work is done.
void check(const CorrectCommand& command) {
    check_image_needed(command);
    refuse_images(command.corrections);
    std::vector<fs::path> inputs = command.corrections;
    inputs.push_back(command.mask.path);
    inputs.push_back(command.image);
    check_outputs(std::array{command.output, command.report, command.provenance_map}, inputs);
    check_output_kind(command.output, FileKind::image);
    check_dicom_images(command.output, command.image);
    check_series(command.series, std::array{command.output});
    if (!command.provenance_map.empty()) {
        check_output_kind(command.provenance_map, FileKind::image);
        if (is_dicom_name(command.provenance_map))
            throw Error(ErrorKind::unsupported, fmt::format("{}: --provenance-map writes .nii, .nii.gz, .nrrd, .mha or .mgz",
                                                            command.provenance_map.string()));
    }
    if (!command.report.empty() && !has_extension(command.report, ".json"))
        throw Error(ErrorKind::unsupported, fmt::format("{} does not end with .json", command.report.string()));
}

Provenance provenance_of(const CorrectCommand& command, const Work& work) {
    std::string options = fmt::format("reach={} drop_loose={}", command.options.reach, command.options.drop_loose);
    if (command.shared_borders) options += " shared_borders=true";
    if (command.label) options += fmt::format(" label={}", *command.label);
    if (command.mask_roi) options += fmt::format(" mask_roi={}", *command.mask_roi);
    std::vector<std::pair<std::string, fs::path>> inputs{{"mask", command.mask.path}};
    for (std::size_t n = 0; n < command.corrections.size(); ++n)
        inputs.emplace_back(n == 0 ? "corrections" : fmt::format("corrections_{}", n + 1), command.corrections[n]);
    if (!command.image.empty()) {
        options += fmt::format(" use_image={}", name(command.use_image));
        if (!is_dicom_name(command.output)) inputs.emplace_back("image", command.image);
    }
    return made_by("correct", inputs, options, work);
}

Facts point_facts(const Vec3& p) { return {p.x, p.y, p.z}; }

Facts report_of(const CorrectReport& report, const std::vector<std::string>& warnings, const Provenance& provenance) {
    Facts planes = Facts::array(), pieces = Facts::array();
    for (const CorrectedPlane& one : report.planes) {
        Facts contours = Facts::array();
        for (const std::size_t contour : one.contours) contours.push_back(contour + 1);
        planes.push_back({{"kind", name(one.kind)},
                          {"origin", point_facts(one.plane.origin)},
                          {"normal", point_facts(one.plane.normal)},
                          {"contours", contours},
                          {"largest_move_mm", one.largest_move_mm}});
    }
    for (const LoosePiece& piece : report.loose_pieces)
        pieces.push_back(
            {{"voxels", piece.voxels}, {"volume_ml", piece.volume_ml}, {"position", point_facts(piece.position)}});
    Facts image = nullptr;
    if (report.image)
        image = {{"weight", report.image->weight},
                 {"planes_left_out", report.image->planes},
                 {"wrong_without", report.image->wrong_without},
                 {"wrong_with", report.image->wrong_with}};
    return {{"version", KONTUR_VERSION},
            {"provenance", provenance_facts(provenance)},
            {"length_mm", report.length_mm},
            {"reach_mm", report.reach_mm},
            {"planes", planes},
            {"voxels",
             {{"added_drawn", report.added_drawn},
              {"removed_drawn", report.removed_drawn},
              {"added_carried", report.added_carried},
              {"removed_carried", report.removed_carried},
              {"added_image", report.added_image},
              {"removed_image", report.removed_image}}},
            {"image", image},
            {"volume_before_ml", report.volume_before_ml},
            {"volume_ml", report.volume_ml},
            {"dice", report.dice},
            {"loose_pieces", pieces},
            {"dropped_loose", report.dropped_loose},
            {"warnings", warnings}};
}

std::vector<LabelName> origin_names() {
    return {{1, "as it was"},      {2, "added where drawn"},  {3, "removed where drawn"}, {4, "added beside"},
            {5, "removed beside"}, {6, "added by the image"}, {7, "removed by the image"}};
}

/// The image where it is to take part and can be read; else it is said why not.
std::optional<Image> shown_in(const CorrectCommand& command, Console& console, const Work& work) {
    if (command.image.empty() || command.use_image == UseImage::off) return {};
    std::string unused;
    std::optional<Image> image = readable_image(image_of(command, console), work, unused);
    if (!unused.empty()) console.warn(unused);
    if (image && is_label_map(*image))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} holds labels, which do not show how far a correction goes; give the image that was "
                                "segmented, or --use-image off",
                                command.image.string()));
    return image;
}

std::vector<std::string> loose_sentences(const CorrectReport& report) {
    std::vector<std::string> sentences;
    if (report.dropped_loose) return sentences;
    for (const LoosePiece& piece : report.loose_pieces)
        sentences.push_back(
            fmt::format("a piece of {:.2g} ml at ({:.1f}, {:.1f}, {:.1f}) mm hangs loose now; --drop-loose "
                        "takes it away",
                        piece.volume_ml, piece.position.x, piece.position.y, piece.position.z));
    return sentences;
}

}  // namespace

CorrectedFile correct_file(const CorrectCommand& command, Console& console, const Work& work) {
    CorrectedFile result{read_mask_file(command, console, work), {}, {}, {}, {}};
    if (command.shared_borders && !result.file.structures.segments.empty())
        refuse_for_labels_alone("--shared-borders", command.mask.path);
    const std::optional<Image> image = shown_in(command, console, work);
    const Mask& mask = result.file.mask;
    ReadCorrections read = read_corrections(command.corrections, command.read);
    result.notes = std::move(read.notes);
    result.corrected =
        correct({mask, ExistingSurface(mask, work), image ? &*image : nullptr}, read.corrections, command.options, work);
    result.warnings = result.corrected.report.warnings;
    for (const auto& some :
         {put(result.file, result.corrected, command.shared_borders, work), loose_sentences(result.corrected.report)})
        result.warnings.insert(result.warnings.end(), some.begin(), some.end());
    result.provenance = provenance_of(command, work);
    return result;
}

void run(const CorrectCommand& command, Console& console) {
    check(command);
    const Work work = console.work(command.threads);
    const CorrectedFile of = correct_file(command, console, work);
    console.note(of.notes);
    for (const std::string& warning : of.warnings) console.warn(warning);
    const CorrectReport& report = of.corrected.report;
    Outputs outputs;
    outputs.write(command.output, [&](const fs::path& path) {
        console.note(write_mask_file(path, of.file, command, of.provenance, console));
    });
    if (!command.provenance_map.empty())
        outputs.write(command.provenance_map, [&](const fs::path& path) {
            kontur::write_image(path, {of.corrected.mask.grid, of.corrected.origin}, origin_names(), of.provenance);
        });
    if (!command.report.empty())
        outputs.write(command.report, [&](const fs::path& path) {
            write_file_atomically(path, to_json_text(report_of(report, of.warnings, of.provenance)));
        });
    outputs.commit();
    if (report.image) console.note(std::array{sentence(*report.image)});
    console.print(fmt::format("{}: {}\n", command.output.string(), sentence(report)));
}

}  // namespace kontur::app
