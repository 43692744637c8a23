#pragma once
#include <filesystem>
#include <string>

namespace faba::test {

/// Exit code of a test program in which something was skipped and nothing failed: ctest lists it as
/// "Skipped", not as passed (SKIP_RETURN_CODE in tests/CMakeLists.txt).
inline constexpr int kSkipped = 77;

/// Marks the running test case as skipped, because of `why`: data or a device is absent, or the machine was
/// late. The case returns afterwards; checks that it still makes count.
void skip(const std::string& why);

/// Whether a file or folder of real data is absent, in which case the running test case is marked as skipped.
bool skipped_without(const std::filesystem::path& path);

}  // namespace faba::test
