// SPDX-License-Identifier: Apache-2.0
#pragma once

// What libc++ leaves out of namespace std where there is one thread alone: locks that are always free. Included before every
// source file; nothing else may see it.

#ifdef __cplusplus
namespace std {

struct mutex {
    void lock() {}
    void unlock() {}
    bool try_lock() { return true; }
};

/// There is nobody to wait for.
struct condition_variable {};

struct thread {
    static unsigned hardware_concurrency() { return 1; }
};

}  // namespace std
#endif
