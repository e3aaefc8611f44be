// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "casters.h"
#include "kontur/shape/provenance.h"

namespace kontur::python {

/// From a dict of str to str, or None for nothing.
inline Provenance provenance_from(const py::object& items) {
    Provenance provenance;
    if (items.is_none()) return provenance;
    for (const auto& [name, value] : items.cast<py::dict>())
        provenance.emplace_back(name.cast<std::string>(), value.cast<std::string>());
    return provenance;
}

}  // namespace kontur::python
