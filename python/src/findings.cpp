// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/measure/contour_check.h"

namespace kontur::python {

void bind_findings(py::module_& m) {
    py::class_<Finding> finding(m, "Finding", "One thing that is wrong or doubtful in a contour set.");
    finding.def_property_readonly(
        "kind", [](const Finding& f) { return std::string(name(f.kind)); },
        "str: 'spike', 'self_crossing', 'contradiction', ...");
    finding.def_property_readonly(
        "severity", [](const Finding& f) { return std::string(name(f.severity)); },
        "str: 'error' (cannot be segmented), 'warning' (probably not meant so) or 'note'.");
    finding.def_readonly("text", &Finding::text, "str: one sentence with the numbers; contours are counted from 1.");
    finding.def_readonly("contour", &Finding::contour, "int, an index, or None.");
    finding.def_readonly("other", &Finding::other, "int, index of a second contour that takes part, or None.");
    finding.def_readonly("position", &Finding::position, "ndarray, shape (3,): mm, where to look; or None.");
    finding.def_readonly("value_mm", &Finding::value_mm, "float: the length that the sentence is about, or None.");
    finding.def("__repr__",
                [](const Finding& f) { return py::str("<Finding {}: {}>").format(std::string(name(f.severity)), f.text); });

    const auto limit = [](auto member) {
        return [member](ContourSetCheckOptions & options) -> auto& { return options.limits.*member; };
    };
    const auto keywords =
        Keywords<ContourSetCheckOptions>()
            .field("plane_tolerance_mm", limit(&ContourCheckOptions::plane_tolerance_mm),
                   "Largest distance of a point from its plane.")
            .field("line_tolerance_mm", limit(&ContourCheckOptions::line_tolerance_mm),
                   "A contour no wider than this is a line.")
            .field("disagreement_mm", &ContourSetCheckOptions::disagreement_mm,
                   "How much contours of different planes may disagree; None: 1.5 % of the contours' diameter.");
    define(
        m, "check_contour_set", R"(Everything that is wrong or doubtful in a contour set, errors first.

Parameters
----------
contours : ContourSet
@options

Returns
-------
list of Finding
    With an error exactly when `check_contours` would refuse the set without its repeated points.

Examples
--------
>>> bow = kontur.Contour([[0, 0, 0], [10, 10, 0], [10, 0, 0], [0, 10, 0]])
>>> [(f.severity, f.kind) for f in kontur.check_contour_set(kontur.ContourSet([bow]))][0]
('warning', 'self_crossing')
)",
        [keywords](const ContourSet& contours, const py::kwargs& given) {
            const ContourSetCheckOptions options = keywords.parse("check_contour_set", given);
            return unlocked([&] { return check_contour_set(contours, options); });
        },
        py::arg("contours"), py::kw_only(), KeywordText(keywords));
}

}  // namespace kontur::python
