// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "archive/http.h"

namespace kontur::archive {

/// A small picture of the middle object of a series, as the archive renders it (DICOM PS3.18, 10.4.1.1.3): the bytes of a
/// JPEG. Throws as `find_instances`, and Error(corrupt_file) for what is no JPEG.
std::string picture_of(Http& http, const Address& series, const Work& work);

}  // namespace kontur::archive
