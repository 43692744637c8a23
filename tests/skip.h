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

/// Declares that the test program works with devices in real time, which are processes too. If a check then
/// fails while other processes take all cores (see cores_taken()), the failure is printed and the program
/// counts as skipped: a device that gets no processor says nothing about the tested code.
void works_in_real_time();

/// Processes that compete for the cores, as a mean over 0.5 s: n threads on n cores with m other busy
/// processes get the share n / (n + m) of the time.
double competing_processes();

/// Whether as many other processes are busy as there are cores: competing_processes(), rounded.
bool cores_taken();

}  // namespace faba::test
