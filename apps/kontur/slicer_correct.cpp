// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "mask_file.h"
#include "outputs.h"
#include "slicer.h"
#include "slicer_module.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "Kontur Correct";
constexpr const char* kPurpose =
    "Corrects a segment by curves in some slices of any orientation, and carries the change on to both sides.";

constexpr const char* kParameters = R"(  <parameters>
    <label>Input and output</label>
    <description><![CDATA[What is wrong, what is right, and what becomes of it]]></description>
    <image type="label">
      <name>wrongLabels</name>
      <label>Label map</label>
      <longflag>--labels</longflag>
      <channel>input</channel>
      <description><![CDATA[A label map to be corrected: export a segmentation to it]]></description>
    </image>
    <integer>
      <name>label</name>
      <label>Label</label>
      <longflag>--label</longflag>
      <description><![CDATA[Which label is corrected; 0: the only one]]></description>
      <default>0</default>
    </integer>
    <image>
      <name>image</name>
      <label>Image</label>
      <longflag>--image</longflag>
      <channel>input</channel>
      <description><![CDATA[What was segmented, if it is to decide how far the change is carried, where that is shown to help at planes left out]]></description>
    </image>
{curves}    <image type="label">
      <name>correctedLabels</name>
      <label>Corrected label map</label>
      <longflag>--corrected</longflag>
      <channel>output</channel>
      <description><![CDATA[All other labels keep their voxels, and so does what lies farther away]]></description>
    </image>
  </parameters>
  <parameters advanced="true">
    <label>More curves</label>
    <description><![CDATA[Further corrections of the same label]]></description>
{more_curves}  </parameters>
  <parameters advanced="true">
    <label>Method</label>
    <description><![CDATA[How far corrections go]]></description>
{curve_kinds}    <string-enumeration>
      <name>loosePieces</name>
      <label>Loose pieces</label>
      <longflag>--loose</longflag>
      <description><![CDATA[What becomes of pieces that a correction cuts off]]></description>
      <default>keep</default>
      <element>keep</element>
      <element>drop</element>
    </string-enumeration>
{numbers}  </parameters>
{results})";

constexpr std::array<SlicerResult, 2> kResults{
    {{"integer", "changedVoxels", "Voxels changed", "Voxels added and removed, in drawn planes and beside them"},
     {"double", "volumeMl", "Volume (ml)", "Volume of the corrected label"}}};

std::string return_parameters(const CorrectReport& report) {
    const std::int64_t changed = report.added_drawn + report.removed_drawn + report.added_carried + report.removed_carried +
                                 report.added_image + report.removed_image;
    return fmt::format("changedVoxels = {}\nvolumeMl = {:.4f}\n", changed, report.volume_ml);
}

void check(const SlicerCorrectCommand& command) {
    const CorrectCommand& correct = command.correct;
    if (correct.corrections.empty()) throw Error(ErrorKind::invalid_input, "no curves were chosen");
    if (correct.output.empty()) throw Error(ErrorKind::invalid_input, "no label map was chosen for the result");
    std::vector<fs::path> inputs = correct.corrections;
    inputs.push_back(correct.mask.path);
    inputs.push_back(correct.image);
    check_outputs(std::array{correct.output, command.return_parameters}, inputs);
}

}  // namespace

void run(const SlicerCorrectCommand& command, Console& console) {
    check(command);
    SlicerRun run(kName);
    const CorrectCommand& correct = command.correct;
    const CorrectedFile result = correct_file(correct, console, run.work(correct.threads, console.stop_token()));
    const CorrectReport& report = result.corrected.report;
    Outputs outputs;
    outputs.write(correct.output,
                  [&](const fs::path& path) { write_mask_file(path, result.file, correct, result.provenance, console); });
    if (!command.return_parameters.empty())
        outputs.write(command.return_parameters,
                      [&](const fs::path& path) { write_file_atomically(path, return_parameters(report)); });
    outputs.commit();
    for (const auto& some : {result.notes, result.warnings})
        for (const std::string& one : some) run.say("warning: " + one);
    if (report.image) run.say(sentence(*report.image));
    run.say(sentence(report));
    run.end();
}

std::string slicer_description(const SlicerCorrectCommand& defaults) {
    const CorrectCommand& correct = defaults.correct;
    const std::string numbers = slicer_number({"double", "reach", "Reach", "--reach",
                                               "How far a correction is carried on: half as far, twice as far",
                                               correct.options.reach, 0.25, 4, 0.25}) +
                                slicer_threads(correct.threads);
    const SlicerCurves curves = slicer_curves(
        "Closed curve, drawn in one slice view: the whole outline there. An open one replaces the piece of the outline "
        "between "
        "its ends, the shorter way round");
    return slicer_module_description(
        kName, kPurpose,
        fmt::format(kParameters, fmt::arg("curves", curves.shown), fmt::arg("more_curves", curves.more),
                    fmt::arg("curve_kinds", curves.kinds), fmt::arg("numbers", numbers),
                    fmt::arg("results", slicer_results(kResults))));
}

}  // namespace kontur::app
