#pragma once
#include <doctest/doctest.h>

#include "tests/e2e/program.h"

namespace faba {

/// Checks that a run is complete, or that it ended with an error that names one of its files and is marked
/// incomplete. The directory may be absent or empty if the mark could not be written.
inline void complete_or_marked(const std::filesystem::path& run, const Called& c) {
  INFO(c.exit, ": ", c.err);
  const bool marked = std::filesystem::exists(run / "incomplete");
  if (c.exit == 0) {
    CHECK_FALSE(marked);
    CHECK(std::filesystem::exists(run / "manifest.json"));
    CHECK(read_file(run / "report.html").find("</html>") != std::string::npos);
    return;
  }
  CHECK(c.exit == 1);
  CHECK(one_clear_line(c.err));
  CHECK(c.err.find("run/") != std::string::npos);
  CHECK((marked || !std::filesystem::exists(run) || std::filesystem::is_empty(run)));
}

}  // namespace faba
