#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "tests/skip.h"

namespace {
int skips = 0;
}

namespace faba::test {

void skip(const std::string& why) {
  ++skips;
  MESSAGE("skipped: ", why);
}

bool skipped_without(const std::filesystem::path& path) {
  if (std::filesystem::exists(path)) return false;
  skip("file not found: " + path.string());
  return true;
}

}  // namespace faba::test

int main(int argc, char** argv) {
  doctest::Context context(argc, argv);
  const int result = context.run();
  if (context.shouldExit() || result != 0 || skips == 0) return result;
  return faba::test::kSkipped;
}
