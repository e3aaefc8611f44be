// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "kontur/base/error.h"

namespace kontur {

/// A NIfTI file says in two ways where its voxels lie, which differ, and none was chosen: Error(unsupported).
class TransformChoiceError : public Error {
public:
    explicit TransformChoiceError(std::string_view message) : Error(ErrorKind::unsupported, message) {}
};

}  // namespace kontur
