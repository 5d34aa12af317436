// SPDX-License-Identifier: MIT
#pragma once

/// Compiles a function once for each width of vector unit and picks one when the program starts, so that one binary
/// runs on any x86-64 and uses what the machine has. Only for functions whose result does not reach the trajectory, or
/// whose lanes are independent: then width changes no bit.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define SHAKEN_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define SHAKEN_VECTOR_CLONES
#endif
