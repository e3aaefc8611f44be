// SPDX-License-Identifier: Apache-2.0
// What stands for zlib and bzip2.
#include "kontur/base/error.h"
#include "kontur/io/bytes/decompress.h"
#include "kontur/io/bytes/deflate.h"

namespace kontur {
namespace {

[[noreturn]] void refuse() {
    throw Error(ErrorKind::unsupported,
                "compressed files are not for this kontur, which was built without zlib, bzip2 and libpng; take a file "
                "without compression (.nii, not .nii.gz)");
}

}  // namespace

std::unique_ptr<Decompressor> make_inflater(Inflation) { refuse(); }

std::unique_ptr<Decompressor> make_bunzip2() { refuse(); }

struct Deflater::Stream {};

Deflater::Deflater(DeflateFormat, Sink, DeflateMode) { refuse(); }

Deflater::~Deflater() = default;

void Deflater::write(std::span<const std::byte>) { refuse(); }

void Deflater::finish() { refuse(); }

}  // namespace kontur
