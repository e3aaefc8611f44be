// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.h"
#include "kontur/fill_labels.h"

namespace kontur::app {

/// What `kontur fill` does but for its words on stdout: reads, fills and writes. What was decided or is doubted on the way
/// is told by `console`. Throws Error before any work for what can be refused at once.
FillReport fill_files(const FillCommand& command, Console& console, const Work& work);

}  // namespace kontur::app
