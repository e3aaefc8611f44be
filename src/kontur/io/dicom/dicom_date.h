// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kontur {

/// YYYY-MM-DD of DICOM's YYYYMMDD; what is no date as it stands.
std::string readable_date(const std::string& stored);

}  // namespace kontur
