// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "kontur/fill_labels.h"

namespace kontur::app {

/// What became of the labels of a file.
struct FilledFile {
    FillReport report;
    std::vector<std::string> names;  ///< of its labels, one for each; "" where the file has none
};

/// "label 3", or with a name "label 3 (Liver)".
std::string title(const FilledFile& filled, std::size_t n);

/// What `kontur fill` does but for its words on stdout: reads, fills and writes. What was decided or is doubted on the way
/// is told by `console`. Throws Error before any work for what can be refused at once.
FilledFile fill_files(const FillCommand& command, Console& console, const Work& work);

}  // namespace kontur::app
