#pragma once

/// Before a function whose loops the compiler turns into vector instructions: compiled for the processor at
/// hand as well as for any, and chosen when the program starts. The results are the same, for this folder is
/// compiled without contracting a product and a sum into one operation. Sanitizers are not ready when that
/// choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define LODESTAR_WIDE_REGISTERS [[gnu::target_clones("avx2", "default")]]
/// And for those processors only that have registers of sixteen floats.
#define LODESTAR_SIXTEEN_LANES [[gnu::target("avx512f")]]
#else
#define LODESTAR_WIDE_REGISTERS
#endif
