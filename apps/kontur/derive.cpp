// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/derive.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "commands.h"
#include "derive_outputs.h"
#include "derive_sources.h"
#include "dicom_output.h"
#include "input_digests.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/view/picture.h"
#include "outputs.h"
#include "rules_file.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

/// Whatever can be refused before any work is done.
void check(const DeriveCommand& command, const std::vector<std::string>& rules) {
    if (rules.empty()) refuse("there are 0 rules; give at least 1, such as 'PTV = CTV + 5 mm', or a --rules FILE");
    if (command.output.empty() && command.rtstruct.empty() && command.table.empty())
        refuse("there is nothing to write; give --output, --rtstruct or --table");
    std::vector<fs::path> inputs = command.inputs;
    for (const fs::path& path : {command.image.path, command.rules_file})
        if (!path.empty()) inputs.push_back(path);
    check_outputs(std::array{command.output, command.rtstruct, command.table}, inputs);
    if (!command.output.empty() && !has_extension(command.output, ".json"))
        check_output_kind(command.output, FileKind::image);
    if (!command.rtstruct.empty() && !is_dicom_name(command.rtstruct))
        throw Error(ErrorKind::unsupported,
                    fmt::format("{} does not end with .dcm, as an RTSTRUCT does", command.rtstruct.string()));
    if (!command.table.empty() && !has_extension(command.table, ".csv"))
        throw Error(ErrorKind::unsupported, fmt::format("{} does not end with .csv", command.table.string()));
    for (const fs::path& output : {command.output, command.rtstruct}) check_dicom_images(output, command.image.path);
    check_holes(command.holes, !command.rtstruct.empty());
    check_series(command.series, std::array{command.output, command.rtstruct});
    check_types(command.types);
    if (has_extension(command.output, ".json") && (rules.size() > 1 || command.with_sources))
        refuse(fmt::format("{} has room for 1 structure; write several to a label map, a SEG or an RTSTRUCT",
                           command.output.string()));
}

std::vector<std::string> all_rules(const DeriveCommand& command) {
    std::vector<std::string> rules = command.rules;
    for (const std::string& rule : rules) check_utf8(rule, "a rule");
    if (command.rules_file.empty()) return rules;
    for (std::string& rule : read_rules_file(command.rules_file)) rules.push_back(std::move(rule));
    return rules;
}

Provenance provenance_of(const DeriveCommand& command, const std::vector<std::string>& rules, const Work& work) {
    std::vector<std::pair<std::string, fs::path>> inputs;
    for (std::size_t n = 0; n < command.inputs.size(); ++n)
        inputs.emplace_back(command.inputs.size() == 1 ? "input" : fmt::format("input_{}", n + 1), command.inputs[n]);
    inputs.emplace_back("image", command.image.path);
    Provenance provenance = made_by("derive", inputs, fmt::format("use_image={}", name(command.segment.use_image)), work);
    for (std::size_t n = 0; n < rules.size(); ++n)
        provenance.emplace_back(fmt::format("rule_{}", n + 1), printable_utf8(rules[n]));
    return provenance;
}

double volume_ml(const Mask& mask) {
    const auto inside = std::count_if(mask.values.begin(), mask.values.end(), [](auto v) { return v != 0; });
    return static_cast<double>(inside) * mask.grid.voxel_volume_mm3() / 1000;
}

/// Of all structures, sources first.
std::vector<StructureRelation> relations_of(DeriveSources sources, const std::vector<DerivedStructure>& derived,
                                            const Work& work) {
    for (const DerivedStructure& one : derived) sources.structures.push_back({one.name, one.mask, {}});
    return relations(sources.structures, work);
}

}  // namespace

void run(const DeriveCommand& command, Console& console) {
    const std::vector<std::string> rules = all_rules(command);
    check(command, rules);
    const Work work = console.work(command.threads);
    const DeriveSources sources = read_derive_sources(command, rules, console, work);
    std::vector<DerivedStructure> derived =
        derive(rules, sources.structures, {.image = sources.image ? &*sources.image : nullptr}, work);
    std::string text;
    for (const DerivedStructure& one : derived) {
        text += fmt::format("{}: {}\n", one.name, in_ml(volume_ml(one.mask)));
        if (one.outlines.contours.empty()) console.warn(fmt::format("'{}' is empty: {}", one.name, one.rule));
    }
    Outputs outputs;
    std::vector<std::string> notes;
    const auto add = [&](const std::vector<std::string>& more) { notes.insert(notes.end(), more.begin(), more.end()); };
    if (!command.table.empty())
        outputs.write(command.table,
                      [&](const fs::path& path) { write_relations(path, relations_of(sources, derived, work)); });
    const std::vector<DeriveOutput> all = derive_outputs(command, sources, std::move(derived), work);
    const Provenance how = provenance_of(command, rules, work);
    if (!command.output.empty())
        outputs.write(command.output, [&](const fs::path& path) { add(write_derived(path, command, all, how, work)); });
    if (!command.rtstruct.empty())
        outputs.write(command.rtstruct, [&](const fs::path& path) { add(write_derived_rtstruct(path, command, all, how)); });
    outputs.commit();
    for (const std::string& note : notes) console.warn(note);
    console.print(text);
}

}  // namespace kontur::app
