// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/error.h"

#include <array>

#include "kontur/base/printable.h"

namespace kontur {
namespace {

struct KindRow {
    ErrorKind kind;
    std::string_view name;
    int exit_code;
};

constexpr std::array kKinds{
    KindRow{ErrorKind::invalid_input, "invalid_input", 65},
    KindRow{ErrorKind::unsupported, "unsupported", 69},
    KindRow{ErrorKind::corrupt_file, "corrupt_file", 66},
    KindRow{ErrorKind::io, "io", 74},
    KindRow{ErrorKind::singular_system, "singular_system", 70},
    KindRow{ErrorKind::too_large, "too_large", 77},
    KindRow{ErrorKind::cancelled, "cancelled", 130},
};

const KindRow& row(ErrorKind kind) noexcept {
    for (const KindRow& candidate : kKinds)
        if (candidate.kind == kind) return candidate;
    return kKinds.front();
}

constexpr std::size_t kMostBytes = 1500;

}  // namespace

Error::Error(ErrorKind kind, std::string_view message) : std::runtime_error(shortened(message, kMostBytes)), kind_(kind) {}

Error Error::with_context(std::string_view context) const { return Error(kind_, std::string(context) + ": " + what()); }

std::string_view name(ErrorKind kind) noexcept { return row(kind).name; }

int exit_code(ErrorKind kind) noexcept { return row(kind).exit_code; }

}  // namespace kontur
