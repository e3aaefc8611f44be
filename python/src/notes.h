// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "casters.h"

namespace kontur::python {

/// Hands what a reader decided for the user to `on_note`, or when that is None to the logger "kontur" as warnings.
inline void give_notes(const std::vector<std::string>& notes, const py::object& on_note) {
    if (notes.empty()) return;
    const py::object take =
        on_note.is_none() ? py::module_::import("logging").attr("getLogger")("kontur").attr("warning") : on_note;
    for (const std::string& note : notes) take(note);
}

inline const py::arg_v kOnNote = py::arg("on_note") = py::none();

}  // namespace kontur::python
