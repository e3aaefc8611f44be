// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kontur {

/// Physical memory of the machine, in MB (10^6 bytes).
double machine_memory_mb();

/// What this process holds of it now; 0 where the system does not say.
double resident_memory_mb();

/// The most that this process has held of it so far.
double peak_memory_mb();

}  // namespace kontur
