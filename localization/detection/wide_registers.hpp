#pragma once

/// Marks a function with loops to vectorize: compiled for AVX2 as well as for the baseline, and selected when
/// the program starts. Results are identical, as this folder is compiled without contraction of multiply and
/// add. Not with sanitizers, which are not ready when the selection runs.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define LODESTAR_WIDE_REGISTERS [[gnu::target_clones("avx2", "default")]]
/// Only for processors with AVX-512 (registers of sixteen floats).
#define LODESTAR_SIXTEEN_LANES [[gnu::target("avx512f")]]
#else
#define LODESTAR_WIDE_REGISTERS
#endif
