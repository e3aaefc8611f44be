// SPDX-License-Identifier: Apache-2.0
// What stands for libpng.
#include "kontur/base/error.h"
#include "kontur/io/bytes/png.h"

namespace kontur {
namespace {

[[noreturn]] void refuse() {
    throw Error(ErrorKind::unsupported, "this kontur writes no PNG, because it was built without libpng");
}

}  // namespace

void write_png(const std::filesystem::path&, const RgbImage&, const Provenance&) { refuse(); }

std::string encode_png(const RgbImage&, const Provenance&) { refuse(); }

void write_animated_png(const std::filesystem::path&, std::span<const RgbImage>, double, const Provenance&) { refuse(); }

}  // namespace kontur
