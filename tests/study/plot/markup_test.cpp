#include "study/plot/markup.h"

#include <doctest/doctest.h>

#include <limits>
#include <string>

using faba::escape_markup;
using faba::three_digits;

TEST_CASE("markup: characters with a meaning in XML are escaped, others are unchanged") {
  CHECK(escape_markup("a<b>&\"c'") == "a&lt;b&gt;&amp;&quot;c&#39;");
  CHECK(escape_markup("σ µm 186 µm/s\tend\n") == "σ µm 186 µm/s\tend\n");
  CHECK(escape_markup("\U0001F9A0") == "\U0001F9A0");
  CHECK(escape_markup("") == "");
}

TEST_CASE("markup: bytes that are not UTF-8, and control characters, become U+FFFD") {
  const std::string replacement = "\uFFFD";
  CHECK(escape_markup("5 \xB5m") == "5 " + replacement + "m");  // Latin-1 micro sign
  CHECK(escape_markup(std::string("a\0b\x1B"
                                  "c",
                                  5)) == "a" + replacement + "b" + replacement + "c");
  CHECK(escape_markup("\xC0\xBC") == replacement + replacement);                    // overlong '<'
  CHECK(escape_markup("\xED\xA0\x80") == replacement + replacement + replacement);  // surrogate
  CHECK(escape_markup("\xE2\x82") == replacement + replacement);                    // truncated
  CHECK(escape_markup("\xE2<") == replacement + "&lt;");                            // the '<' is kept
}

TEST_CASE("markup: three significant digits") {
  CHECK(three_digits(0) == "0");
  CHECK(three_digits(0.4871) == "0.487");
  CHECK(three_digits(4.7333) == "4.73");
  CHECK(three_digits(26.666) == "26.7");
  CHECK(three_digits(312.6) == "313");
  CHECK(three_digits(36182.4) == "36182");
  CHECK(three_digits(0.09999999) == "0.100");  // rounds up to the next power of ten
  CHECK(three_digits(9.9999) == "10.0");
  CHECK(three_digits(999999.7) == "1.00\u00A0×\u00A010⁶");
  CHECK(three_digits(-2.5) == "\u22122.50");
  CHECK(three_digits(0.0012345) == "0.00123");
  CHECK(three_digits(2.5e-7) == "2.50\u00A0×\u00A010⁻⁷");
  CHECK(three_digits(1.25e7) == "1.25\u00A0×\u00A010⁷");
  CHECK(three_digits(std::numeric_limits<double>::quiet_NaN()) == "–");
  CHECK(three_digits(std::numeric_limits<double>::infinity()) == "–");
}
