// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "define.h"
#include "kontur/editor.h"

namespace kontur::python {

/// LiveEditor, which takes Editor's keywords.
void bind_live_editor(py::module_& m, const Keywords<EditorOptions>& keywords);

}  // namespace kontur::python
