// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "kontur/base/work.h"

namespace kontur {

/// Number of threads for a request: `requested` if > 0, the machine's for 0. Throws Error(invalid_input) below that.
int thread_count(int requested);

/// Runs `body(begin, end)` over [0, count) in chunks of `chunk` items on up to `threads` threads (0: the machine's), the
/// calling one included. Chunk boundaries depend on `count` and `chunk` only, never on `threads`, so a body that writes
/// its own items gives the same bytes for any number of threads. The first exception of a body is rethrown here after
/// all threads have stopped.
void parallel_for(std::int64_t count, std::int64_t chunk, int threads,
                  const std::function<void(std::int64_t begin, std::int64_t end)>& body);

/// The same on the work's threads. Looks before each chunk whether to stop, and throws Error(cancelled) then.
void parallel_for(std::int64_t count, std::int64_t chunk, const Work& work,
                  const std::function<void(std::int64_t begin, std::int64_t end)>& body);

}  // namespace kontur
