// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/workers.h"

namespace kontur {

Workers& Workers::instance() {
    static Workers workers;
    return workers;
}

/// There is nobody to help.
void Workers::run(int, const std::function<void()>& work) { work(); }

}  // namespace kontur
