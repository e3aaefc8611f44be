// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "kontur/base/error.h"

namespace kontur {

/// The slices of a DICOM series do not lie evenly, and were not to be resampled: Error(unsupported) that says where.
class UnevenSlicesError : public Error {
public:
    explicit UnevenSlicesError(std::string_view message) : Error(ErrorKind::unsupported, message) {}
};

}  // namespace kontur
