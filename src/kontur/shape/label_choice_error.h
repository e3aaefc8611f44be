// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "kontur/base/error.h"

namespace kontur {

/// A label map has several labels, and none was chosen: Error(invalid_input) that lists them.
class LabelChoiceError : public Error {
public:
    explicit LabelChoiceError(std::string_view message) : Error(ErrorKind::invalid_input, message) {}
};

}  // namespace kontur
