// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "fill.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "outputs.h"
#include "slicer.h"
#include "slicer_module.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "Kontur Fill";
constexpr const char* kPurpose =
    "Fills a label map between its painted slices: across any axis or several, each label for itself and those that touch "
    "together.";

constexpr const char* kParameters = R"(  <parameters>
    <label>Input and output</label>
    <description><![CDATA[What is painted, and what becomes of it]]></description>
    <image type="label">
      <name>paintedLabels</name>
      <label>Painted slices</label>
      <longflag>--labels</longflag>
      <channel>input</channel>
      <description><![CDATA[A label map of which some slices are painted: export a segmentation to it]]></description>
    </image>
    <image>
      <name>image</name>
      <label>Image</label>
      <longflag>--image</longflag>
      <channel>input</channel>
      <description><![CDATA[What was painted on, if it is to tell how the surface runs between the slices, where that is shown to help at slices left out]]></description>
    </image>
    <image type="label">
      <name>filledLabels</name>
      <label>Filled label map</label>
      <longflag>--filled</longflag>
      <channel>output</channel>
      <description><![CDATA[What was painted, voxel for voxel, and what lies between]]></description>
    </image>
  </parameters>
  <parameters advanced="true">
    <label>Method</label>
    <description><![CDATA[What is filled, and how]]></description>
    <string-enumeration>
      <name>ends</name>
      <label>Ends</label>
      <longflag>--ends</longflag>
      <description><![CDATA[How far beyond the first and last of parallel slices: not at all (closed), half of a gap (half), or as far as the fit says (open)]]></description>
      <default>{ends}</default>
      <element>closed</element>
      <element>half</element>
      <element>open</element>
    </string-enumeration>
{numbers}  </parameters>
{results})";

constexpr std::array<SlicerResult, 2> kResults{
    {{"integer", "filledLabelCount", "Labels", "How many labels were painted"},
     {"integer", "addedVoxels", "Voxels added", "Voxels that were filled, of all labels"}}};

/// Values that 3D Slicer shows in the panel: lines NAME = VALUE.
std::string return_parameters(const FillReport& report) {
    std::int64_t added = 0;
    for (const FilledLabel& one : report.labels) added += one.added_voxels;
    return fmt::format("filledLabelCount = {}\naddedVoxels = {}\n", report.labels.size(), added);
}

}  // namespace

void run(const SlicerFillCommand& command, Console& console) {
    if (command.fill.output.empty()) throw Error(ErrorKind::invalid_input, "no label map was chosen for the result");
    check_outputs(std::array{command.fill.output, command.return_parameters},
                  std::array{command.fill.labels.path, command.fill.image});
    SlicerRun run(kName);
    const FilledFile filled = fill_files(command.fill, console, run.work(command.fill.threads, console.stop_token()));
    if (!command.return_parameters.empty())
        write_file_atomically(command.return_parameters, return_parameters(filled.report));
    for (std::size_t n = 0; n < filled.report.labels.size(); ++n) {
        const FilledLabel& one = filled.report.labels[n];
        for (const std::string& warning : one.warnings) run.say(fmt::format("warning: {}: {}", title(filled, n), warning));
        if (one.image.verdict != ImageVerdict::none) run.say(fmt::format("{}: {}", title(filled, n), sentence(one.image)));
    }
    run.end();
}

std::string slicer_description(const SlicerFillCommand& defaults) {
    const FillOptions& o = defaults.fill.options;
    const std::string numbers =
        slicer_number({"double", "shapeWeight", "Shape weight", "--shape_weight",
                       "Share of the shape-based interpolation beside the fit, between parallel slices; 0: the fit alone",
                       o.shape_weight, 0, 1, 0.1}) +
        slicer_number({"double", "smoothingVoxels", "Smoothing (voxels)", "--smoothing_voxels",
                       "Smoothing of the painted outlines, standard deviation", o.smoothing_voxels, 0, 5, 0.1}) +
        slicer_threads(defaults.fill.threads);
    return slicer_module_description(kName, kPurpose,
                                     fmt::format(kParameters, fmt::arg("ends", name(o.ends)), fmt::arg("numbers", numbers),
                                                 fmt::arg("results", slicer_results(kResults))));
}

}  // namespace kontur::app
