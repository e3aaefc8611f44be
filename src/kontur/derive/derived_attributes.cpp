// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/derived_attributes.h"

#include <string>
#include <utility>

#include "kontur/base/printable.h"

namespace kontur {
namespace {

std::string type_by_name(const std::string& name) {
    const std::string small = lower_case(name);
    for (const auto& [start, type] : {std::pair{"gtv", "GTV"}, std::pair{"ctv", "CTV"}, std::pair{"ptv", "PTV"}})
        if (small.starts_with(start)) return type;
    return small == "body" || small == "external" ? "EXTERNAL" : "";
}

}  // namespace

StructureAttributes derived_attributes(const DerivedStructure& derived) {
    StructureAttributes attributes;
    attributes.interpreted_type = type_by_name(derived.name);
    attributes.generation_algorithm = "AUTOMATIC";
    attributes.description = "derived: " + derived.rule;
    return attributes;
}

}  // namespace kontur
