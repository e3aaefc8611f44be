// SPDX-License-Identifier: Apache-2.0
#include "derive_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "dicom_output.h"
#include "drawn_on.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/contours.h"
#include "kontur/segment.h"
#include "structures.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

/// A structure of a file, before anything is made of it.
struct FileStructure {
    std::string name;
    fs::path file;
    std::variant<Mask, Roi> content;
    StructureAttributes attributes;
};

void add_rois(const fs::path& path, Console& console, std::vector<FileStructure>& found) {
    StructureSet set = read_rtstruct(path);
    console.note(set.notes);
    for (Roi& roi : set.rois) {
        StructureAttributes attributes = roi.contours.attributes;
        const std::string name = roi.name;
        found.push_back({name, path, std::move(roi), std::move(attributes)});
    }
}

void add_contours(const fs::path& path, Console& console, std::vector<FileStructure>& found) {
    ReadContours read = read_contours(path);
    console.note(read.notes);
    const std::string file_name = path.filename().string();
    if (read.contours.name.empty()) read.contours.name = printable_utf8(file_name.substr(0, file_name.find('.', 1)));
    Roi roi;
    roi.name = read.contours.name;
    roi.frame_of_reference_uid = read.frame_of_reference_uid;
    roi.contours = std::move(read.contours);
    StructureAttributes attributes = roi.contours.attributes;
    const std::string name = roi.name;
    found.push_back({name, path, std::move(roi), std::move(attributes)});
}

void add_masks(const ImageInput& input, const Work& work, std::vector<FileStructure>& found) {
    Structures all = read_structures(input, work);
    for (std::size_t n = 0; n < all.segments.size(); ++n)
        found.push_back({all.segments[n].label, input.path, std::move(all.masks[n]), attributes_of(all.segments[n])});
}

std::vector<FileStructure> read_inputs(const DeriveCommand& command, Console& console, const Work& work) {
    std::vector<FileStructure> found;
    for (const fs::path& path : command.inputs) {
        const FileKind kind = input_kind(path);
        if (kind == FileKind::mesh)
            throw Error(ErrorKind::unsupported,
                        fmt::format("{} holds a surface; rules take label maps and contours, and kontur "
                                    "correct reads a surface as a mask",
                                    path.string()));
        if (kind == FileKind::image) add_masks({path, console.noting(command.image.options)}, work, found);
        else if (is_rtstruct(path)) add_rois(path, console, found);
        else add_contours(path, console, found);
    }
    return found;
}

const FileStructure& the_one(const std::vector<FileStructure>& all, const std::string& name) {
    const auto is_it = [&](const FileStructure& one) { return one.name == name; };
    const auto first = std::find_if(all.begin(), all.end(), is_it);
    const auto second = std::find_if(first + 1, all.end(), is_it);
    if (second != all.end())
        refuse(fmt::format("'{}' is in {} and in {}; give one of them another name", name, first->file.string(),
                           second->file.string()));
    return *first;
}

/// What was drawn on: the grid of the label maps, or else of the image.
struct Scene {
    Grid grid;
    std::optional<Image> image;      ///< where its voxels matter
    std::optional<Grid> drawn_on{};  ///< by contours
};

Scene read_scene(const DeriveCommand& command, const std::vector<const FileStructure*>& needed, bool asks_body,
                 Console& console, const Work& work) {
    const auto has_mask = [](const FileStructure* one) { return std::holds_alternative<Mask>(one->content); };
    const auto masked = std::find_if(needed.begin(), needed.end(), has_mask);
    const bool has_contours = !std::all_of(needed.begin(), needed.end(), has_mask);
    if (command.image.path.empty()) {
        if (masked != needed.end()) return {std::get<Mask>((*masked)->content).grid, {}};
        if (has_contours)
            refuse(fmt::format("{} holds contours, which have no voxels; give the image that shows them with --image",
                               needed.front()->file.string()));
        refuse("there are 0 inputs with structures; give them with --input, and for body() an --image");
    }
    const ImageInput images{command.image.path, console.noting(command.image.options)};
    Scene scene;
    if (asks_body) {
        scene.image = read_image(images.path, images.options, work);
        scene.grid = scene.image->grid;
    } else if (has_contours) {
        std::vector<std::string> notes;
        DrawnOn drawn_on = read_drawn_on(images, command.segment.use_image, work, notes);
        console.note(notes);
        scene = {drawn_on.grid, std::move(drawn_on.image), drawn_on.grid};
    }
    if (masked != needed.end()) scene.grid = std::get<Mask>((*masked)->content).grid;
    return scene;
}

NamedStructure structure_of(const FileStructure& from, const Scene& scene, const DeriveCommand& command, Console& console,
                            const Work& work) {
    if (const Mask* const mask = std::get_if<Mask>(&from.content)) return {from.name, *mask, {}};
    const Roi& roi = std::get<Roi>(from.content);
    if (!roi.damage.empty()) throw Error(ErrorKind::corrupt_file, fmt::format("{}: {}", from.file.string(), roi.damage));
    console.note(roi.notes);
    console.note(frame_of_reference_notes(roi.frame_of_reference_uid, command.image));
    SegmentOptions options = command.segment;
    options.drawn_on = scene.drawn_on;
    try {
        Segmentation segmentation = segment(roi.contours, scene.grid, scene.image ? &*scene.image : nullptr, options, work);
        for (const std::string& warning : segmentation.report.warnings)
            console.warn(fmt::format("{}: {}", from.name, warning));
        return {from.name, std::move(segmentation.mask), std::move(segmentation.function)};
    } catch (const Error& error) {
        throw error.with_context(fmt::format("{}: '{}'", from.file.string(), from.name));
    }
}

}  // namespace

DeriveSources read_derive_sources(const DeriveCommand& command, const std::vector<std::string>& rules, Console& console,
                                  const Work& work) {
    const std::vector<FileStructure> all = read_inputs(command, console, work);
    std::vector<std::string> names;
    for (const FileStructure& one : all) names.push_back(one.name);
    check_rules(rules, names, !command.image.path.empty());
    const bool asks_body = std::any_of(rules.begin(), rules.end(),
                                       [](const std::string& rule) { return rule.find("body") != std::string::npos; });
    std::vector<const FileStructure*> needed;
    for (const std::string& name : sources_of(rules)) needed.push_back(&the_one(all, name));
    Scene scene = read_scene(command, needed, asks_body, console, work);
    DeriveSources sources;
    for (const FileStructure* one : needed) {
        sources.structures.push_back(structure_of(*one, scene, command, console, work));
        sources.attributes.push_back(one->attributes);
    }
    if (asks_body) sources.image = std::move(scene.image);
    return sources;
}

}  // namespace kontur::app
