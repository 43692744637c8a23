#pragma once

/// Before a loop whose pointers may be equal, but then element by element.
#if defined(__clang__)
#define FABA_ELEMENTWISE _Pragma("clang loop vectorize(assume_safety)")
#else
#define FABA_ELEMENTWISE _Pragma("GCC ivdep")
#endif

/// Marks a loop's function to be compiled for AVX-512, AVX2 and plain SSE2, the best one chosen when the
/// program starts. All three give the same bits: no fused multiply-add is used (-ffp-contract=off).
/// Sanitizers do not work with the resolver functions this needs, so their builds take the plain version.
/// FABA_ONE_ISA asks for that, too.
#if defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && defined(__OPTIMIZE__) && !defined(FABA_ONE_ISA)
#define FABA_VECTORISED [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define FABA_VECTORISED
#endif
