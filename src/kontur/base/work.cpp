// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/work.h"

#include "kontur/base/error.h"

namespace kontur {

void Work::report(std::string_view stage, double fraction) const {
    if (callback) callback(stage, fraction);
    check();
}

void Work::check() const {
    if (stop.stop_requested()) throw Error(ErrorKind::cancelled, "cancelled by the caller");
}

}  // namespace kontur
