// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/shape/structure_attributes.h"

namespace kontur::python {
namespace {

void bind_code(py::module_& m) {
    py::class_<CodedConcept> code(m, "CodedConcept", R"(A term of a coding scheme, as DICOM names organs. Immutable.

Parameters
----------
value : str
scheme : str
    'SCT', 'FMA', ...
meaning : str
    In words.

Examples
--------
>>> kontur.CodedConcept("10200004", "SCT", "Liver")
<CodedConcept 10200004 of SCT: 'Liver'>
)");
    constructor(
        code,
        [](std::string value, std::string scheme, std::string meaning) {
            return CodedConcept{std::move(value), std::move(scheme), std::move(meaning)};
        },
        py::arg("value"), py::arg("scheme"), py::arg("meaning") = "");
    code.def_readonly("value", &CodedConcept::value, "str");
    code.def_readonly("scheme", &CodedConcept::scheme, "str");
    code.def_readonly("meaning", &CodedConcept::meaning, "str: in words; may be empty.");
    code.def(
        "__eq__", [](const CodedConcept& a, const CodedConcept& b) { return a == b; }, py::is_operator());
    code.def("__repr__", [](const CodedConcept& c) {
        return py::str("<CodedConcept {} of {}: {!r}>").format(c.value, c.scheme, c.meaning);
    });
    picklable(code, [](const CodedConcept& c) { return py::make_tuple(c.value, c.scheme, c.meaning); });
}

void bind_property(py::module_& m) {
    py::class_<PhysicalProperty> property(
        m, "PhysicalProperty", R"(What dose calculation takes for a structure in place of what the CT shows. Immutable.

Parameters
----------
property : str
    'REL_ELEC_DENSITY', 'REL_MASS_DENSITY', ...
value : float
)");
    constructor(
        property,
        [](std::string name, double value) {
            return PhysicalProperty{std::move(name), value};
        },
        py::arg("property"), py::arg("value"));
    property.def_readonly("property", &PhysicalProperty::property, "str");
    property.def_readonly("value", &PhysicalProperty::value, "float");
    property.def(
        "__eq__", [](const PhysicalProperty& a, const PhysicalProperty& b) { return a == b; }, py::is_operator());
    property.def("__repr__",
                 [](const PhysicalProperty& p) { return py::str("<PhysicalProperty {}: {}>").format(p.property, p.value); });
    picklable(property, [](const PhysicalProperty& p) { return py::make_tuple(p.property, p.value); });
}

StructureAttributes attributes_from(std::optional<std::array<std::uint8_t, 3>> color, std::string interpreted_type,
                                    std::string generation_algorithm, std::string description,
                                    std::optional<std::int64_t> number, std::optional<CodedConcept> category,
                                    std::optional<CodedConcept> code, std::vector<PhysicalProperty> physical_properties) {
    return {color,
            std::move(interpreted_type),
            std::move(generation_algorithm),
            std::move(description),
            number,
            std::move(category),
            std::move(code),
            std::move(physical_properties)};
}

}  // namespace

void bind_attributes(py::module_& m) {
    bind_code(m);
    bind_property(m);
    using Attributes = StructureAttributes;
    py::class_<Attributes> type(m, "StructureAttributes",
                                R"(What files say about a structure beside its name and where it is.

kontur carries it from file to file and computes nothing with it. Immutable.

Parameters
----------
color : (int, int, int), optional
    Red, green, blue, 0 to 255.
interpreted_type : str
    'ORGAN', 'GTV', 'EXTERNAL', ...; may be empty.
generation_algorithm : {'', 'AUTOMATIC', 'SEMIAUTOMATIC', 'MANUAL'}
description : str
number : int, optional
    Of its ROI, by which plans and dose files name it.
category, code : CodedConcept, optional
    What sort of thing it is, and what it is.
physical_properties : sequence of PhysicalProperty

Examples
--------
>>> about = kontur.StructureAttributes(color=(255, 0, 0), interpreted_type="GTV")
>>> kontur.ContourSet([], name="tumour", attributes=about).attributes.color
[255, 0, 0]
)");
    constructor(type, &attributes_from, py::arg("color") = py::none(), py::arg("interpreted_type") = "",
                py::arg("generation_algorithm") = "", py::arg("description") = "", py::arg("number") = py::none(),
                py::arg("category") = py::none(), py::arg("code") = py::none(),
                py::arg("physical_properties") = py::tuple());
    type.def_readonly("color", &Attributes::color, "list of 3 int (red, green, blue, 0 to 255), or None.");
    type.def_readonly("interpreted_type", &Attributes::interpreted_type, "str: 'GTV', 'ORGAN', ...; may be empty.");
    type.def_readonly("generation_algorithm", &Attributes::generation_algorithm, "str: may be empty.");
    type.def_readonly("description", &Attributes::description, "str: may be empty.");
    type.def_readonly("number", &Attributes::number, "int or None: of its ROI.");
    type.def_readonly("category", &Attributes::category, "CodedConcept, or None: what sort of thing it is.");
    type.def_readonly("code", &Attributes::code, "CodedConcept, or None: what it is.");
    type.def_readonly("physical_properties", &Attributes::physical_properties, "list of PhysicalProperty");
    type.def(
        "__eq__", [](const Attributes& a, const Attributes& b) { return a == b; }, py::is_operator());
    type.def("__repr__", [](const Attributes& a) {
        return py::str("<StructureAttributes color={} type={!r}>").format(a.color, a.interpreted_type);
    });
    picklable(type, [](const Attributes& a) {
        return py::make_tuple(a.color, a.interpreted_type, a.generation_algorithm, a.description, a.number, a.category,
                              a.code, a.physical_properties);
    });
}

}  // namespace kontur::python
