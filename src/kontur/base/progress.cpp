// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/progress.h"

#include "kontur/base/error.h"

namespace kontur {

void Progress::report(std::string_view stage, double fraction) const {
    if (callback) callback(stage, fraction);
    check();
}

void Progress::check() const {
    if (stop.stop_requested()) throw Error(ErrorKind::cancelled, "cancelled by the caller");
}

}  // namespace kontur
