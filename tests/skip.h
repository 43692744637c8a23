#pragma once
#include <filesystem>
#include <string>

namespace faba::test {

/// Exit code of a test program with a skipped test case and no failure: ctest lists it as "Skipped" and not
/// as passed (SKIP_RETURN_CODE in tests/CMakeLists.txt).
inline constexpr int kSkipped = 77;

/// Marks the running test case as skipped for the reason `why`: data or a device is absent, or the machine
/// was too slow. The test case should then return; checks after this call still count.
void skip(const std::string& why);

/// Whether a file or folder of recordings is absent; if so, marks the running test case as skipped.
bool skipped_without(const std::filesystem::path& path);

}  // namespace faba::test
