#pragma once

namespace faba {

/// Vector of as many T as fit into `bytes` bytes, with no alignment requirement beyond that of T.
template <class T, int bytes>
struct Wide {
  using type __attribute__((vector_size(bytes), aligned(alignof(T)), may_alias)) = T;
};

}  // namespace faba

/// Defines a function `name` from a template `name_in<bytes>`, compiled for the vector lengths of AVX-512,
/// AVX2 and SSE2; the longest that the processor supports is used. Compilers keep longer vectors in memory.
/// Element-wise results are bit-identical for all lengths. The template must be [[gnu::always_inline]].
/// Sanitizer builds, other compilers and other processors use the shortest, which is that of NEON.
// NOLINTBEGIN(bugprone-macro-parentheses): the arguments are lists in parentheses already
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && defined(__OPTIMIZE__) && !defined(FABA_ONE_ISA)
#define FABA_WIDE(name, parameters, arguments)                                             \
  [[gnu::target("arch=x86-64-v4")]] void name##_64 parameters { name##_in<64> arguments; } \
  [[gnu::target("arch=x86-64-v3")]] void name##_32 parameters { name##_in<32> arguments; } \
  void name parameters {                                                                   \
    static const bool longest = __builtin_cpu_supports("x86-64-v4"),                       \
                      middle = __builtin_cpu_supports("x86-64-v3");                        \
    if (longest) return name##_64 arguments;                                               \
    if (middle) return name##_32 arguments;                                                \
    name##_in<16> arguments;                                                               \
  }
#else
#define FABA_WIDE(name, parameters, arguments) \
  void name parameters { name##_in<16> arguments; }
#endif
// NOLINTEND(bugprone-macro-parentheses)
