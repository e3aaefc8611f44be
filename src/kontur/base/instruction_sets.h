// SPDX-License-Identifier: Apache-2.0
#pragma once

// KONTUR_X86_64_LEVEL is the level of x86-64 that hot functions are compiled for: 1 or 3 (AVX2), which only
// tests/determinism asks for; 0 compiles them for both and for 4 (AVX-512) and chooses when the program starts.
#if !defined(__x86_64__) || !defined(__GNUC__) || defined(__clang__)
#undef KONTUR_X86_64_LEVEL
#define KONTUR_X86_64_LEVEL 1
#elif !defined(KONTUR_X86_64_LEVEL)
#define KONTUR_X86_64_LEVEL 0
#endif

// In front of a hot function. Every level gives the same bytes where contraction is off, which it is unless
// kontur/CMakeLists.txt turns it on for a file. Sanitizers cannot instrument the compiler's choice among clones: with them
// there is but one.
#if KONTUR_X86_64_LEVEL == 3
#define KONTUR_EVERY_INSTRUCTION_SET __attribute__((target("arch=x86-64-v3")))
#elif KONTUR_X86_64_LEVEL == 0 && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define KONTUR_EVERY_INSTRUCTION_SET __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define KONTUR_EVERY_INSTRUCTION_SET
#endif

#if KONTUR_X86_64_LEVEL != 1
namespace kontur {

/// The level of x86-64 that functions run on which are chosen among by hand.
inline int x86_64_level() {
    if constexpr (KONTUR_X86_64_LEVEL > 0) return KONTUR_X86_64_LEVEL;
    const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512cd");
#ifdef __SANITIZE_ADDRESS__
    constexpr bool kAligned = false;  // its stack aligns no variable to 64 bytes (GCC's bug 110027)
#else
    constexpr bool kAligned = true;
#endif
    return v4 && kAligned ? 4 : v3 ? 3 : 1;
}

}  // namespace kontur
#endif
