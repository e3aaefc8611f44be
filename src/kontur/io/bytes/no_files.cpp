// SPDX-License-Identifier: Apache-2.0
// For WebAssembly, which has no files to write.
#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"

namespace kontur {

void write_file_atomically(const std::filesystem::path& target, const std::function<void(AtomicFile&)>&) {
    throw Error(ErrorKind::unsupported, "there is no file system to write " + target.string() + " to");
}

void write_file_atomically(const std::filesystem::path& target, std::string_view) {
    write_file_atomically(target, std::function<void(AtomicFile&)>());
}

}  // namespace kontur
