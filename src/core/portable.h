#pragma once
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <type_traits>

/// Functions of the C++20 library that the library of Emscripten 3.1 (libc++ 13) lacks. With other compilers
/// they are those of the library.
namespace faba::portable {

#if defined(__cpp_lib_bit_cast)
using std::bit_cast;
#else
template <class To, class From>
[[gnu::always_inline]] inline constexpr To bit_cast(const From& from) {
  static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> &&
                std::is_trivially_copyable_v<From>);
  return __builtin_bit_cast(To, from);
}
#endif

/// std::from_chars() for a double in decimal notation, by the C library. Does not read infinities and NaN.
inline std::from_chars_result from_chars_by_strtod(const char* first, const char* last, double& value) {
  // The longest number at the start: strtod() also accepts spaces, "+" and hexadecimal digits.
  const auto digits = [last](const char* p) {
    while (p != last && std::isdigit(static_cast<unsigned char>(*p))) ++p;
    return p;
  };
  const char* const start = first != last && *first == '-' ? first + 1 : first;
  const char* const before_point = digits(start);
  const char* end = before_point;
  std::ptrdiff_t count = before_point - start;
  if (end != last && *end == '.') {
    end = digits(before_point + 1);
    count += end - before_point - 1;
  }
  if (count == 0) return {first, std::errc::invalid_argument};
  const char* const mantissa = end;
  if (end != last && (*end == 'e' || *end == 'E')) {
    const char* power = end + 1;
    if (power != last && (*power == '-' || *power == '+')) ++power;
    const char* const after = digits(power);
    if (after != power) end = after;
  }
  const double read = std::strtod(std::string(first, end).c_str(), nullptr);
  const bool zero = std::string(start, mantissa).find_first_of("123456789") == std::string::npos;
  if (std::isinf(read) || (read == 0 && !zero)) return {end, std::errc::result_out_of_range};
  value = read;
  return {end, std::errc{}};
}

/// std::from_chars() for a double.
inline std::from_chars_result from_chars(const char* first, const char* last, double& value) {
#if defined(__cpp_lib_to_chars)
  return std::from_chars(first, last, value);
#else
  return from_chars_by_strtod(first, last, value);
#endif
}

}  // namespace faba::portable
