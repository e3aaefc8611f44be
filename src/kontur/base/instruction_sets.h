// SPDX-License-Identifier: Apache-2.0
#pragma once

// In front of a hot function: compile it for AVX-512, for AVX2 and for any x86-64, and choose when the program starts. With
// contraction off (see the top CMakeLists.txt) all of them give the same bytes. Sanitizers cannot instrument the choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define KONTUR_CHOOSES_INSTRUCTION_SET 1
#define KONTUR_EVERY_INSTRUCTION_SET __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define KONTUR_CHOOSES_INSTRUCTION_SET 0
#define KONTUR_EVERY_INSTRUCTION_SET
#endif
