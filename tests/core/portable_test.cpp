#include "core/portable.h"

#include <doctest/doctest.h>

#include <limits>
#include <random>
#include <string>

namespace portable = faba::portable;

TEST_CASE("a number that strtod() reads is that of std::from_chars()") {
  const auto compare = [](const std::string& text) {
    INFO(text);
    double expected = 0.5, read = 0.5;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), expected);
    const auto [same_end, same_error] =
        portable::from_chars_by_strtod(text.data(), text.data() + text.size(), read);
    CHECK(same_error == error);
    CHECK(same_end == end);
    CHECK(portable::bit_cast<std::uint64_t>(read) == portable::bit_cast<std::uint64_t>(expected));
  };
  for (const char* text :
       {"0",     "-0",     "1.5 um/s", "1e-3",  "-12.e4x", ".5",         "5.",       "1e", "1e+",
        "2e5e6", "0x10",   "",         "-",     ".",       "+1",         " 1",       "e5", "--1",
        "1e400", "-1e400", "1e-400",   "0e999", "0.1",     "340.000001", "4.9e-324", "1,5"})
    compare(text);
  std::mt19937_64 engine(1);
  for (int i = 0; i < 2000; ++i) {
    const auto value = portable::bit_cast<double>(engine());
    if (value - value != 0) continue;  // not finite
    char text[64];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    compare(std::string(text, end));
  }
}
