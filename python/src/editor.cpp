// SPDX-License-Identifier: Apache-2.0
#include "kontur/editor.h"

#include <memory>
#include <mutex>

#include "bindings.h"
#include "live_editor.h"
#include "segment_words.h"

namespace kontur::python {
namespace {

/// The library's editor is for one thread at a time.
struct SharedEditor {
    explicit SharedEditor(const EditorOptions& options) : editor(options) {}

    Editor editor;
    std::recursive_mutex mutex;  // a progress callback may call the editor again
};

Keywords<EditorOptions> editor_keywords() {
    const auto segment = [](auto member) {
        return [member](EditorOptions & options) -> auto& { return options.segment.*member; };
    };
    return Keywords<EditorOptions>()
        .field("preview_spacing_mm", &EditorOptions::preview_spacing_mm,
               "Of the preview's lattice; 0: twice the finished surface's.")
        .field(
            "finished_spacing_mm", &EditorOptions::finished_spacing_mm,
            "Of the finished surface's; 0: 1 % of the contours' diameter, or down to half of that where a drawn section is "
            "narrower than four steps.")
        .field("preview_points", &EditorOptions::preview_points,
               "About how many of the drawn points a preview is fitted to.")
        .field("kernel", segment(&SegmentOptions::kernel), "As for `segment`, like those that follow.")
        .field("normals", segment(&SegmentOptions::normals), "")
        .field("normal_offset_mm", segment(&SegmentOptions::normal_offset_mm), "")
        .field("smoothing", segment(&SegmentOptions::smoothing), "")
        .field("conflicts", segment(&SegmentOptions::conflicts), "")
        .field("fill_rule", segment(&SegmentOptions::fill_rule), "")
        .field("corners", segment(&SegmentOptions::corners), "")
        .field("quality", segment(&SegmentOptions::quality), "")
        .field("solver", segment(&SegmentOptions::solver), "")
        .field("tolerance_mm", segment(&SegmentOptions::tolerance_mm), "");
}

void bind_editor_itself(py::module_& m) {
    py::class_<EditedSurface> surface(m, "EditedSurface", "The surface through a set of contours.");
    surface.def_readonly("finished", &EditedSurface::finished, "bool: False for a preview.");
    surface.def_readonly("function", &EditedSurface::function, "ImplicitFunction");
    surface.def_readonly("mesh", &EditedSurface::mesh, "TriangleMesh: empty without contours.");
    surface.def_readonly("spacing_mm", &EditedSurface::spacing_mm, "float: of the lattice that the mesh was made on.");
    surface.def_readonly("residual", &EditedSurface::residual, "Residual: at all drawn points; finished surfaces only.");
    surface.def_readonly("near_lines", &EditedSurface::near_lines,
                         "list of NearLines: lines of one plane that count as one or leave a thin wall.");
    surface.def_readonly("section_check", &EditedSurface::section_check,
                         "SectionCheck: against what was drawn; finished surfaces only.");
    surface.def_readonly("solves", &EditedSurface::solves, "int: how often a linear system was solved for it.");
    surface.def_readonly("image", &EditedSurface::image, "ImageReport: what became of the image; finished surfaces only.");
    surface.def_property_readonly(
        "seconds", [](const EditedSurface& s) { return py::dict(py::cast(s.seconds)); },
        "dict of str to float: wall time by stage; previews only.");

    const Keywords<EditorOptions> keywords = editor_keywords();
    const std::string help = filled_in(R"(Follows contours while they are edited.

After each edit `preview` gives a surface quickly, then `finish` the one that `segment` would give, with an image or without.
Threads that share one wait for each other.

Parameters
----------
@options

Examples
--------
>>> contours = kontur.phantom_case("kidney_radial6").contours
>>> editor = kontur.Editor(preview_spacing_mm=2)
>>> fewer = kontur.ContourSet(contours.contours[:5])
>>> editor.preview(fewer).finished, editor.preview(contours).finished, editor.finish(contours).finished
(False, False, True)
)",
                                       keywords.documentation());
    py::class_<SharedEditor> editor(m, "Editor", help.c_str());
    const std::string init_doc = docstring("__init__", "self, *", "", KeywordText(keywords));
    editor.def(py::init([keywords](const py::kwargs& given) {
                   return std::make_unique<SharedEditor>(keywords.parse("Editor", given));
               }),
               init_doc.c_str());
    method(
        editor, "preview", "The EditedSurface through a ContourSet, fitted to a part of its points.",
        [](SharedEditor& self, const ContourSet& contours, int threads, const py::object& progress, const py::object& stop) {
            return run({progress, stop, threads}, [&](const Work& work) {
                const std::lock_guard lock(self.mutex);
                return self.editor.preview(contours, work);
            });
        },
        py::arg("contours"), py::kw_only(), kThreads, kProgress, kStop);
    method(
        editor, "finish",
        "The final EditedSurface through a ContourSet: the same function as `segment`'s, with the `image` if one is given.",
        [](SharedEditor& self, const ContourSet& contours, const Image* image, int threads, const py::object& progress,
           const py::object& stop) {
            return run({progress, stop, threads}, [&](const Work& work) {
                const std::lock_guard lock(self.mutex);
                return self.editor.finish(contours, image, work);
            });
        },
        py::arg("contours"), py::kw_only(), py::arg("image") = py::none(), kThreads, kProgress, kStop);
}

}  // namespace

void bind_editor(py::module_& m) {
    bind_editor_itself(m);
    bind_live_editor(m, editor_keywords());
}

}  // namespace kontur::python
