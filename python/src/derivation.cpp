// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "fields.h"
#include "kontur/derive/derive.h"
#include "kontur/segment.h"

namespace kontur::python {
namespace {

std::vector<std::string> rules_from(const py::object& given) {
    if (py::isinstance<py::str>(given)) return {given.cast<std::string>()};
    return given.cast<std::vector<std::string>>();
}

std::vector<NamedStructure> structures_from(const py::dict& given) {
    std::vector<NamedStructure> structures;
    for (const auto& [name, value] : given) {
        if (py::isinstance<Segmentation>(value)) {
            const auto& segmentation = value.cast<const Segmentation&>();
            structures.push_back({name.cast<std::string>(), segmentation.mask, segmentation.function});
        } else if (py::isinstance<Mask>(value)) {
            structures.push_back({name.cast<std::string>(), value.cast<const Mask&>(), {}});
        } else {
            throw py::type_error("structures: a Mask or a Segmentation is needed, not " +
                                 py::repr(value).cast<std::string>());
        }
    }
    return structures;
}

/// Of two masks, or of one and a length.
Mask by_rule(const std::string& expression, const Mask& a, const Mask* b = nullptr) {
    return unlocked([&] {
        std::vector<NamedStructure> structures{{"a", a, {}}};
        if (b) structures.push_back({"b", *b, {}});
        return derive(std::vector<std::string>{"made = " + expression}, structures).front().mask;
    });
}

Mask by_length(const char* sign, const Mask& mask, double mm) {
    if (!(mm >= 0))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the margin is {} mm, but must be at least 0; - moves inwards", mm));
    return by_rule(fmt::format("a {} {:.9f} mm", sign, mm), mask);
}

void bind_operators(py::module_& m) {
    auto mask = py::reinterpret_borrow<py::class_<Mask>>(m.attr("Mask"));
    mask.def(
        "__add__", [](const Mask& a, double mm) { return by_length("+", a, mm); }, py::is_operator());
    mask.def(
        "__sub__", [](const Mask& a, double mm) { return by_length("-", a, mm); }, py::is_operator());
    mask.def(
        "__sub__", [](const Mask& a, const Mask& b) { return by_rule("a - b", a, &b); }, py::is_operator());
    mask.def(
        "__or__", [](const Mask& a, const Mask& b) { return by_rule("a | b", a, &b); }, py::is_operator());
    mask.def(
        "__and__", [](const Mask& a, const Mask& b) { return by_rule("a & b", a, &b); }, py::is_operator());
}

void bind_types(py::module_& m) {
    py::class_<DerivedStructure> derived(m, "DerivedStructure", "What a rule made.");
    Fields(derived)
        .field("name", &DerivedStructure::name, "str")
        .field("rule", &DerivedStructure::rule, "str: as it was given.")
        .field("sources", &DerivedStructure::sources, "list of str: the structures that it names.")
        .field("mask", &DerivedStructure::mask, "Mask: on the grid of the structures.")
        .field("outlines", &DerivedStructure::outlines,
               "ContourSet: closed contours around the mask's voxel centres on each slice, at sub-voxel places.");
    derived.def("__repr__", [](const DerivedStructure& self) {
        return py::str("<DerivedStructure {!r}: {!r}>").format(self.rule, py::cast(self.mask));
    });
    py::class_<StructureRelation> relation(m, "StructureRelation", "Two structures against each other.");
    Fields(relation)
        .field("a", &StructureRelation::a, "str")
        .field("b", &StructureRelation::b, "str")
        .field("volume_a_ml", &StructureRelation::volume_a_ml, "float")
        .field("volume_b_ml", &StructureRelation::volume_b_ml, "float")
        .field("overlap_ml", &StructureRelation::overlap_ml, "float")
        .field("least_distance_mm", &StructureRelation::least_distance_mm,
               "float or None: of the surfaces; 0 where they overlap. None when a mask is empty.")
        .field("a_beyond_b_mm", &StructureRelation::a_beyond_b_mm, "float: how far a sticks out of b at most.")
        .field("b_beyond_a_mm", &StructureRelation::b_beyond_a_mm, "float")
        .field("a_beyond_b", &StructureRelation::a_beyond_b, "ndarray, shape (3,): mm, where it does.")
        .field("b_beyond_a", &StructureRelation::b_beyond_a, "ndarray, shape (3,): mm")
        .picklable();
}

}  // namespace

void bind_derivation(py::module_& m) {
    bind_types(m);
    bind_operators(m);
    define(
        m, "derive", R"(Makes structures of structures by rules, as `kontur derive` does.

A margin is a distance in mm in space from the surface. The surface of a Segmentation is that of its function, and the
surface of a Mask runs between its voxels.

Parameters
----------
rules : str or sequence of str
    Such as 'PTV = CTV + 5 mm - (Cord + 3 mm)'. A rule may name what another one makes.
structures : dict of str to Mask or Segmentation
    By the names that rules give them; of one grid.
image : Image, optional
    What body() looks at; on the same grid.
@threads
@progress

Returns
-------
dict of str to DerivedStructure
    In the order of the rules.

Raises
------
InvalidInputError
    With a mark at the place, for what is no rule, a name that stands for nothing and rules in a circle; for structures of
    several grids.
CancelledError

Examples
--------
>>> z, y, x = np.mgrid[:40, :40, :40]
>>> grid = kontur.Grid((40, 40, 40), np.eye(4), frame="LPS")
>>> tumour = kontur.Mask((z - 20) ** 2 + (y - 20) ** 2 + (x - 20) ** 2 < 10**2, grid)
>>> made = kontur.derive(["PTV = CTV + 5 mm", "Ring = PTV - CTV"], {"CTV": tumour})
>>> made["PTV"].mask.volume_ml > 3 * tumour.volume_ml
True
>>> bool(np.array_equal((tumour + 5).values, made["PTV"].mask.values))
True
)",
        [](const py::object& rules, const py::dict& structures, const Image* image, int threads, const py::object& progress,
           const py::object& stop) {
            const std::vector<std::string> texts = rules_from(rules);
            const std::vector<NamedStructure> named = structures_from(structures);
            std::vector<DerivedStructure> derived = run(
                {progress, stop, threads}, [&](const Work& work) { return derive(texts, named, {.image = image}, work); });
            py::dict by_name;
            for (DerivedStructure& one : derived) {
                const py::str name(one.name);  // before the structure is moved from
                by_name[name] = py::cast(std::move(one));
            }
            return by_name;
        },
        py::arg("rules"), py::arg("structures"), py::kw_only(), py::arg("image") = py::none(), kThreads, kProgress, kStop);
    define(
        m, "relations", R"(Structures against each other: volumes, overlap, least distance, how far one sticks out.

Parameters
----------
structures : dict of str to Mask or Segmentation
    Of one grid.
@threads
@progress

Returns
-------
list of StructureRelation
    Of each pair, in the order of the structures.

Raises
------
InvalidInputError
    For structures of several grids.
CancelledError

Examples
--------
>>> z, y, x = np.mgrid[:30, :30, :30]
>>> grid = kontur.Grid((30, 30, 30), np.eye(4), frame="LPS")
>>> low, high = (kontur.Mask((abs(z - place) < 3) & (abs(y - 15) < 5) & (abs(x - 15) < 5), grid) for place in (8, 20))
>>> kontur.relations({"low": low, "high": high})[0].least_distance_mm
7.0
)",
        [](const py::dict& structures, int threads, const py::object& progress, const py::object& stop) {
            const std::vector<NamedStructure> named = structures_from(structures);
            return run({progress, stop, threads}, [&](const Work& work) { return relations(named, work); });
        },
        py::arg("structures"), py::kw_only(), kThreads, kProgress, kStop);
}

}  // namespace kontur::python
