#define DOCTEST_CONFIG_IMPLEMENT  // the next line alone says it to a header that was not precompiled
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
