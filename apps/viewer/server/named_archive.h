// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "archive/http.h"

namespace kontur::viewer {

/// The archive that the command named: the only one that pages reach, and that without its address or its password.
struct NamedArchive {
    archive::Address service;
    archive::Access access;
};

}  // namespace kontur::viewer
