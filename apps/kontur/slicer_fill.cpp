// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "fill.h"
#include "kontur/base/error.h"
#include "kontur/io/atomic_file.h"
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
    <double>
      <name>shapeWeight</name>
      <label>Shape weight</label>
      <longflag>--shape_weight</longflag>
      <description><![CDATA[Share of the shape-based interpolation beside the fit, between parallel slices; 0: the fit alone]]></description>
      <default>{shape_weight}</default>
      <constraints>
        <minimum>0</minimum>
        <maximum>1</maximum>
        <step>0.1</step>
      </constraints>
    </double>
    <double>
      <name>smoothingVoxels</name>
      <label>Smoothing (voxels)</label>
      <longflag>--smoothing_voxels</longflag>
      <description><![CDATA[Smoothing of the painted outlines, standard deviation]]></description>
      <default>{smoothing_voxels}</default>
      <constraints>
        <minimum>0</minimum>
        <maximum>5</maximum>
        <step>0.1</step>
      </constraints>
    </double>
    <integer>
      <name>threads</name>
      <label>Threads</label>
      <longflag>--threads</longflag>
      <description><![CDATA[0: as many as the machine has]]></description>
      <default>{threads}</default>
      <constraints>
        <minimum>0</minimum>
        <maximum>256</maximum>
        <step>1</step>
      </constraints>
    </integer>
  </parameters>
  <parameters>
    <label>Result</label>
    <description><![CDATA[What was found]]></description>
    <integer>
      <name>filledLabelCount</name>
      <label>Labels</label>
      <channel>output</channel>
      <default>0</default>
      <description><![CDATA[How many labels were painted]]></description>
    </integer>
    <integer>
      <name>addedVoxels</name>
      <label>Voxels added</label>
      <channel>output</channel>
      <default>0</default>
      <description><![CDATA[Voxels that were filled, of all labels]]></description>
    </integer>
  </parameters>
)";

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
    const FillReport report = fill_files(command.fill, console, run.work(command.fill.threads, console.stop_token()));
    if (!command.return_parameters.empty()) write_file_atomically(command.return_parameters, return_parameters(report));
    for (const FilledLabel& one : report.labels) {
        for (const std::string& warning : one.warnings) run.say(fmt::format("warning: label {}: {}", one.label, warning));
        if (one.image.verdict != ImageVerdict::none) run.say(fmt::format("label {}: {}", one.label, sentence(one.image)));
    }
    run.end();
}

std::string slicer_description(const SlicerFillCommand& defaults) {
    const FillOptions& o = defaults.fill.options;
    return slicer_module_description(
        kName, kPurpose,
        fmt::format(kParameters, fmt::arg("ends", name(o.ends)), fmt::arg("shape_weight", o.shape_weight),
                    fmt::arg("smoothing_voxels", o.smoothing_voxels), fmt::arg("threads", defaults.fill.threads)));
}

}  // namespace kontur::app
