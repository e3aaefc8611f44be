// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kontur/shape/volume.h"

namespace kontur::viewer {

/// Names an image by what it holds: size, sample type and a 64-bit hash of geometry (rounded to a micrometre) and voxels.
/// The same image in another format or folder has the same name. It tells images apart, it does not protect against forgery.
std::string fingerprint(const Image& image);

}  // namespace kontur::viewer
