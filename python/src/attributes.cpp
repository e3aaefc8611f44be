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

void bind_approval(py::module_& m) {
    py::class_<Approval> approval(m, "Approval", R"(That somebody takes a structure as it is for right. Immutable.

Parameters
----------
by : str
    A name; empty where a file names nobody.
at : str
    Local time, as '2026-11-30T21:02:43'; empty where a file has none.
)");
    constructor(
        approval,
        [](std::string by, std::string at) {
            return Approval{std::move(by), std::move(at)};
        },
        py::arg("by") = "", py::arg("at") = "");
    approval.def_readonly("by", &Approval::by, "str: may be empty.");
    approval.def_readonly("at", &Approval::at, "str: local time; may be empty.");
    approval.def(
        "__eq__", [](const Approval& a, const Approval& b) { return a == b; }, py::is_operator());
    approval.def("__repr__", [](const Approval& a) { return py::str("<Approval by {!r} at {}>").format(a.by, a.at); });
    picklable(approval, [](const Approval& a) { return py::make_tuple(a.by, a.at); });
}

void bind_review(py::module_& m) {
    bind_approval(m);
    py::class_<Review> review(m, "Review", R"(What reviewers said of a structure. Immutable.

Parameters
----------
approved : Approval, optional
    None: nobody approved it as it is.
comment : str
locked : bool
    Whether no edit is to change it.

Examples
--------
>>> review = kontur.Review(kontur.Approval("Doe", "2026-11-30T21:02:43"), comment="cropped to the body")
>>> kontur.StructureAttributes(review=review).review.approved.by
'Doe'
)");
    constructor(
        review,
        [](std::optional<Approval> approved, std::string comment, bool locked) {
            return Review{std::move(approved), std::move(comment), locked};
        },
        py::arg("approved") = py::none(), py::arg("comment") = "", py::arg("locked") = false);
    review.def_readonly("approved", &Review::approved, "Approval, or None.");
    review.def_readonly("comment", &Review::comment, "str: in words; may be empty.");
    review.def_readonly("locked", &Review::locked, "bool: no edit is to change it.");
    review.def(
        "__eq__", [](const Review& a, const Review& b) { return a == b; }, py::is_operator());
    review.def("__repr__", [](const Review& r) {
        return py::str("<Review approved={!r} comment={!r} locked={}>").format(r.approved, r.comment, r.locked);
    });
    picklable(review, [](const Review& r) { return py::make_tuple(r.approved, r.comment, r.locked); });
}

StructureAttributes attributes_from(std::optional<std::array<std::uint8_t, 3>> color, std::string interpreted_type,
                                    std::string generation_algorithm, std::string description,
                                    std::optional<std::int64_t> number, std::optional<CodedConcept> category,
                                    std::optional<CodedConcept> code, std::vector<PhysicalProperty> physical_properties,
                                    std::optional<Review> review) {
    return {color,
            std::move(interpreted_type),
            std::move(generation_algorithm),
            std::move(description),
            number,
            std::move(category),
            std::move(code),
            std::move(physical_properties),
            std::move(review).value_or(Review{})};
}

}  // namespace

void bind_attributes(py::module_& m) {
    bind_code(m);
    bind_property(m);
    bind_review(m);
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
review : Review, optional

Examples
--------
>>> about = kontur.StructureAttributes(color=(255, 0, 0), interpreted_type="GTV")
>>> kontur.ContourSet([], name="tumour", attributes=about).attributes.color
[255, 0, 0]
)");
    constructor(type, &attributes_from, py::arg("color") = py::none(), py::arg("interpreted_type") = "",
                py::arg("generation_algorithm") = "", py::arg("description") = "", py::arg("number") = py::none(),
                py::arg("category") = py::none(), py::arg("code") = py::none(), py::arg("physical_properties") = py::tuple(),
                py::arg("review") = py::none());
    type.def_readonly("color", &Attributes::color, "list of 3 int (red, green, blue, 0 to 255), or None.");
    type.def_readonly("interpreted_type", &Attributes::interpreted_type, "str: 'GTV', 'ORGAN', ...; may be empty.");
    type.def_readonly("generation_algorithm", &Attributes::generation_algorithm, "str: may be empty.");
    type.def_readonly("description", &Attributes::description, "str: may be empty.");
    type.def_readonly("number", &Attributes::number, "int or None: of its ROI.");
    type.def_readonly("category", &Attributes::category, "CodedConcept, or None: what sort of thing it is.");
    type.def_readonly("code", &Attributes::code, "CodedConcept, or None: what it is.");
    type.def_readonly("physical_properties", &Attributes::physical_properties, "list of PhysicalProperty");
    type.def_readonly("review", &Attributes::review, "Review: what reviewers said of it.");
    type.def(
        "__eq__", [](const Attributes& a, const Attributes& b) { return a == b; }, py::is_operator());
    type.def("__repr__", [](const Attributes& a) {
        return py::str("<StructureAttributes color={} type={!r}>").format(a.color, a.interpreted_type);
    });
    picklable(type, [](const Attributes& a) {
        return py::make_tuple(a.color, a.interpreted_type, a.generation_algorithm, a.description, a.number, a.category,
                              a.code, a.physical_properties, a.review);
    });
}

}  // namespace kontur::python
