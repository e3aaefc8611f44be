// SPDX-License-Identifier: Apache-2.0
#include "slicer.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "commands.h"
#include "contour_files.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/file_digest.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/segment.h"
#include "outputs.h"
#include "slicer_module.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "Kontur Segment";
constexpr const char* kPurpose =
    "Smooth surface and mask of an object from closed curves drawn in slices of any orientation.";

constexpr const char* kCurveKinds = R"(    <string-enumeration>
      <name>curves</name>
      <label>Curves</label>
      <longflag>--curves</longflag>
      <description><![CDATA[The line between the points of a curve: as 3D Slicer draws a new one (spline), or straight, as in its curves of type linear (polygon)]]></description>
      <default>spline</default>
      <element>spline</element>
      <element>polygon</element>
    </string-enumeration>
)";

constexpr const char* kParameters = R"(  <parameters>
    <label>Input and output</label>
    <description><![CDATA[What is drawn, on what, and what becomes of it]]></description>
    <image>
      <name>referenceVolume</name>
      <label>Reference volume</label>
      <longflag>--reference</longflag>
      <channel>input</channel>
      <description><![CDATA[The image that was drawn on; the label map has its voxels]]></description>
    </image>
{curves}    <image type="label">
      <name>outputMask</name>
      <label>Label map</label>
      <longflag>--mask</longflag>
      <channel>output</channel>
      <description><![CDATA[The object as a label map]]></description>
    </image>
    <geometry fileExtensions=".ply">
      <name>outputModel</name>
      <label>Model</label>
      <longflag>--model</longflag>
      <channel>output</channel>
      <description><![CDATA[The object's surface]]></description>
    </geometry>
  </parameters>
  <parameters advanced="true">
    <label>More curves</label>
    <description><![CDATA[Further curves of the same object]]></description>
{more_curves}  </parameters>
  <parameters advanced="true">
    <label>Method</label>
    <description><![CDATA[How the surface runs through the curves]]></description>
{curve_kinds}    <string-enumeration>
      <name>kernel</name>
      <label>Kernel</label>
      <longflag>--kernel</longflag>
      <description><![CDATA[Radial function: triharmonic (r^3), screened (r^3 that goes back to a mean) or biharmonic (r)]]></description>
      <default>{kernel}</default>
      <element>triharmonic</element>
      <element>screened</element>
      <element>biharmonic</element>
    </string-enumeration>
    <string-enumeration>
      <name>normals</name>
      <label>Normals</label>
      <longflag>--normals</longflag>
      <description><![CDATA[Direction of the surface at a curve: from all curves together (surface), or in the curve's own plane (in-plane)]]></description>
      <default>{normals}</default>
      <element>surface</element>
      <element>in-plane</element>
    </string-enumeration>
{numbers}  </parameters>
{results})";

constexpr std::array<SlicerResult, 3> kResults{
    {{"double", "volumeMl", "Volume (ml)", "Volume of the label map"},
     {"double", "residualMaxMm", "Largest residual (mm)", "Largest distance of the surface from a drawn point"},
     {"integer", "components", "Components", "Connected parts of the label map"}}};

/// Values that 3D Slicer shows in the panel: lines NAME = VALUE.
std::string return_parameters(const SegmentReport& report) {
    return fmt::format("volumeMl = {:.4f}\nresidualMaxMm = {:.4f}\ncomponents = {}\n", report.mask_volume_ml,
                       report.residual.max_mm, report.mask_components);
}

void check(const SlicerCommand& command) {
    if (command.contours.empty()) throw Error(ErrorKind::invalid_input, "no contours were chosen");
    if (command.output_mask.empty() && command.output_model.empty())
        throw Error(ErrorKind::invalid_input, "neither a label map nor a model was chosen for the result");
    if (!command.output_mask.empty()) check_output_kind(command.output_mask, FileKind::image);
    if (!command.output_model.empty()) check_output_kind(command.output_model, FileKind::mesh);
    std::vector<fs::path> inputs = command.contours;
    inputs.push_back(command.reference);
    check_outputs(std::array{command.output_mask, command.output_model, command.return_parameters}, inputs);
}

struct SegmentedModel {
    ContourSet contours;
    Segmentation result;
};

void write_outputs(const SlicerCommand& command, const SegmentedModel& model, const Work& work) {
    const Segmentation& result = model.result;
    Provenance how = provenance(model.contours, result.mask.grid, result.report);
    how.emplace_back("contour_files_sha256", files_sha256(command.contours, work));
    how.emplace_back("image_sha256", file_sha256(command.reference, work));
    Outputs outputs;
    if (!command.output_mask.empty())
        outputs.write(command.output_mask, [&](const fs::path& path) { write_mask(path, result.mask, {}, how); });
    if (!command.output_model.empty())
        outputs.write(command.output_model, [&](const fs::path& path) { write_mesh(path, *result.mesh, how); });
    if (!command.return_parameters.empty())
        outputs.write(command.return_parameters,
                      [&](const fs::path& path) { write_file_atomically(path, return_parameters(result.report)); });
    outputs.commit();
}

SegmentedModel fit(const SlicerCommand& command, const Work& work) {
    ReadContours contours = read_contours_to_fit(command.contours, command.read);
    const Grid grid = read_grid(command.reference, {}, work);
    SegmentOptions options = command.options;
    options.mesh = !command.output_model.empty();
    options.drawn_on = grid;
    Segmentation result = segment(contours.contours, grid, options, work);
    result.report.warnings.insert(result.report.warnings.begin(), contours.notes.begin(), contours.notes.end());
    return {std::move(contours.contours), std::move(result)};
}

constexpr int kCurvesInFront = 6, kMostCurves = 24;

std::string curve_flag(int number) { return number == 1 ? "--contour" : fmt::format("--contour_{}", number); }

/// One for each curve, because 3D Slicer passes one node for a parameter, whatever its attribute "multiple" says. They take
/// any type of markup: its parser means to allow "closedcurve", and refuses just that (as of August 2026).
std::string curve_parameters(int first, int last, std::string_view description) {
    std::string text;
    for (int number = first; number <= last; ++number)
        text += fmt::format(R"(    <pointfile type="any" fileExtensions=".mrk.json" coordinateSystem="lps">
      <name>curve{0}</name>
      <label>Curve {0}</label>
      <longflag>{1}</longflag>
      <channel>input</channel>
      <description><![CDATA[{2}]]></description>
    </pointfile>
)",
                            number, curve_flag(number), description);
    return text;
}

}  // namespace

std::vector<std::string> slicer_curve_flags() {
    std::vector<std::string> flags;
    for (int number = 1; number <= kMostCurves; ++number) flags.push_back(curve_flag(number));
    return flags;
}

SlicerCurves slicer_curves(std::string_view description) {
    return {curve_parameters(1, kCurvesInFront, description), curve_parameters(kCurvesInFront + 1, kMostCurves, description),
            kCurveKinds};
}

void run(const SlicerCommand& command, Console& console) {
    check(command);
    SlicerRun run(kName);
    const SegmentedModel model = fit(command, run.work(command.threads, console.stop_token()));
    write_outputs(command, model, Work{.stop = console.stop_token()});
    for (const std::string& warning : model.result.report.warnings) run.say("warning: " + warning);
    run.end();
}

std::string slicer_description(const SlicerCommand& defaults) {
    const SegmentOptions& o = defaults.options;
    const std::string numbers = slicer_number({"double", "quality", "Quality", "--quality",
                                               "Fraction of each curve's points that is used", o.quality, 0.05, 1, 0.05}) +
                                slicer_threads(defaults.threads);
    const SlicerCurves curves = slicer_curves(
        "Closed curve around the object, drawn in one slice view. Open curves are stretches of the border, points lie on "
        "the "
        "surface");
    return slicer_module_description(
        kName, kPurpose,
        fmt::format(kParameters, fmt::arg("curves", curves.shown), fmt::arg("more_curves", curves.more),
                    fmt::arg("curve_kinds", curves.kinds), fmt::arg("kernel", name(o.kernel)),
                    fmt::arg("normals", name(o.normals)), fmt::arg("numbers", numbers),
                    fmt::arg("results", slicer_results(kResults))));
}

}  // namespace kontur::app
