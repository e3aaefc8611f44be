// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_date.h"

#include <algorithm>
#include <cctype>

namespace kontur {

std::string readable_date(const std::string& stored) {
    const bool is_date = stored.size() == 8 &&
                         std::all_of(stored.begin(), stored.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    return is_date ? stored.substr(0, 4) + "-" + stored.substr(4, 2) + "-" + stored.substr(6) : stored;
}

}  // namespace kontur
