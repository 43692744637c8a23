#pragma once

namespace faba {

/// As many T as fit into so many bytes, computed with at once; anywhere in memory.
template <class T, int bytes>
struct Wide {
  using type __attribute__((vector_size(bytes), aligned(alignof(T)), may_alias)) = T;
};

}  // namespace faba

/// Makes a function `name` of a template `name_in<bytes>`, compiled for vectors as long as the registers of
/// AVX-512, AVX2 and SSE2; the longest that the processor has is used. Longer ones a compiler would keep in
/// memory. What is computed element by element is the same bits in all of them. The template must be
/// [[gnu::always_inline]]. Sanitized builds and other compilers take the shortest.
// NOLINTBEGIN(bugprone-macro-parentheses): what is given are lists in parentheses already
#if defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
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
