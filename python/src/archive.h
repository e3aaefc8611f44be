// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bindings.h"

namespace kontur::python {

/// Adds what speaks with archives to its submodule.
void bind_archive(py::module_& archive);

}  // namespace kontur::python
