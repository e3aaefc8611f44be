// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "bindings.h"
#include "fields.h"
#include "kontur/segment_together.h"
#include "segment_keywords.h"

namespace kontur::python {

template <>
struct Words<Relation> {
    static constexpr std::array values{Relation::exclusive, Relation::inside, Relation::overlap};
};

namespace {

/// A structure by its position or by its name.
std::size_t position_of(const py::handle& word, const std::vector<ContourSet>& structures) {
    if (!py::isinstance<py::str>(word)) return word.cast<std::size_t>();
    const auto name = word.cast<std::string>();
    const auto has_name = [&](const ContourSet& set) { return set.name == name; };
    const auto found = std::find_if(structures.begin(), structures.end(), has_name);
    if (const auto count = std::count_if(structures.begin(), structures.end(), has_name); count != 1)
        throw Error(ErrorKind::invalid_input, "a rule is about '" + name + "', which " + std::to_string(count) +
                                                  " structures are called; 1 is needed");
    return static_cast<std::size_t>(found - structures.begin());
}

std::vector<StructurePair> rules_from(const py::sequence& given, const std::vector<ContourSet>& structures) {
    std::vector<StructurePair> rules;
    for (const py::handle& entry : given) {
        const auto rule = entry.cast<py::sequence>();
        if (rule.size() != 3)
            throw Error(ErrorKind::invalid_input, "a rule has " + std::to_string(rule.size()) +
                                                      " parts; 3 are needed: structure, relation, structure");
        rules.push_back({position_of(rule[0], structures), position_of(rule[2], structures), rule[1].cast<Relation>()});
    }
    return rules;
}

void bind_types(py::module_& m) {
    py::class_<StructurePair> pair(m, "StructurePair", "What two structures are to each other.");
    Fields(pair)
        .field("first", &StructurePair::first, "int: position of a structure, from 0.")
        .field("second", &StructurePair::second, "int")
        .field("relation", &StructurePair::relation, "str: 'exclusive', 'inside' (the first in the second) or 'overlap'.")
        .field("shared_voxels", &StructurePair::shared_voxels, "int: of the two masks fitted each alone.")
        .field("is_given", &StructurePair::is_given, "bool: by a rule; else it follows from the masks.")
        .picklable();
    py::class_<Together> type(m, "Together", "What `segment_together` made: structures of one grid.");
    type.def_readonly("grid", &Together::grid, "Grid");
    type.def_readonly("structures", &Together::structures,
                      "list of Segmentation: each with its mask on the box around it, and its function as fitted alone.");
    type.def_readonly("pairs", &Together::pairs,
                      "list of StructurePair: those whose masks share voxels or faces, and those of the rules.");
    type.def_readonly("contested_voxels", &Together::contested_voxels, "int: claimed by two that exclude each other.");
    type.def_readonly("closed_voxels", &Together::closed_voxels, "int: of gaps between them.");
    type.def_readonly(
        "borrowed_points", &Together::borrowed_points,
        "int: of borders that a neighbour alone has drawn in a plane, to which a structure was fitted once more.");
    method(
        type, "mask", R"(The mask of one of them on the whole grid.

Parameters
----------
structure : int
    Its position, from 0.

Returns
-------
Mask

Raises
------
IndexError
)",
        [](const Together& together, std::size_t structure) {
            return unlocked([&] { return whole_mask(together, structure); });
        },
        py::arg("structure"));
}

}  // namespace

void bind_together(py::module_& m) {
    bind_types(m);
    const auto keywords = segment_keywords();
    define(
        m, "segment_together", R"(Segments several structures so that those that exclude each other become a partition.

Each is fitted by itself. A voxel that two of them claim goes to the one that it lies deepest in, and what lies between two
that touch and belongs to none of them to the nearest. A border that one of them alone has drawn in a plane counts for its
neighbour, too. Other Python threads run meanwhile.

Parameters
----------
contours : sequence of ContourSet
    One for each structure.
grid : Grid
image : Image, optional
    What was drawn on, for `use_image`.
rules : sequence of (structure, relation, structure)
    What is known of pairs: structures by position or name, and 'exclusive', 'inside' (the first in the second, which gets its
    voxels, too) or 'overlap'. What no rule says follows from the masks: inside from 80 % of the smaller one on, overlap from
    25 % on, else exclusive.
@threads
@progress
@options

Returns
-------
Together

Raises
------
InvalidInputError
    As `segment` does, with the structure's name or number in front, and for rules that make no sense.
SingularSystemError, TooLargeError, CancelledError

Examples
--------
>>> liver = kontur.phantom_case("liver_oblique10")
>>> metastasis = kontur.phantom_case("metastasis_parallel7")
>>> both = kontur.segment_together([liver.contours, metastasis.contours], liver.grid)
>>> [(pair.first, pair.relation, pair.second) for pair in both.pairs]
[(1, 'inside', 0)]
>>> both.mask(0).values.shape == liver.grid.shape
True
)",
        [keywords](const std::vector<ContourSet>& contours, const Grid& grid, const Image* image, const py::sequence& rules,
                   int threads, const py::object& progress, const py::object& stop, const py::kwargs& given) {
            const TogetherOptions options{.segment = keywords.parse("segment_together", given),
                                          .rules = rules_from(rules, contours)};
            return run({progress, stop, threads},
                       [&](const Work& work) { return segment_together(contours, grid, image, options, work); });
        },
        py::arg("contours"), py::arg("grid"), py::kw_only(), py::arg("image") = py::none(), py::arg("rules") = py::tuple(),
        kThreads, kProgress, kStop, KeywordText(keywords));
}

}  // namespace kontur::python
