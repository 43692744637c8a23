#pragma once

/// For a loop whose pointers may be equal, but do not overlap in any other way.
#if defined(__clang__)
#define FABA_ELEMENTWISE _Pragma("clang loop vectorize(assume_safety)")
#else
#define FABA_ELEMENTWISE _Pragma("GCC ivdep")
#endif

/// Compiles a function for AVX-512, AVX2 and SSE2; the best version is chosen at program start. All three
/// give the same bits: there is no fused multiply-add (-ffp-contract=off). Sanitizers do not support the
/// resolver functions that this needs, so their builds use SSE2 only, as do builds with FABA_ONE_ISA. On
/// other processors there is one version, for the vectors that all of them have (NEON on arm64).
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && defined(__OPTIMIZE__) && !defined(FABA_ONE_ISA)
#define FABA_VECTORISED [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define FABA_VECTORISED
#endif
