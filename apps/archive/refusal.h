// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "archive/http.h"
#include "kontur/base/error.h"

namespace kontur::archive {

/// What an answer that is no success means, in one sentence with a way out; `what` was asked for or sent, such as "the study
/// https://..." or "seg.dcm". Error(invalid_input) for what is not there, Error(too_large), else Error(io).
Error refusal(const Answer& answer, const Http& http, const std::string& what);

}  // namespace kontur::archive
