#pragma once
#include <doctest/doctest.h>

#include "tests/e2e/program.h"

namespace faba {

/// Checks that a command in the folder ends with this exit code, without output, and with one clear line that
/// contains `words`.
inline void refused(const TestFolder& f, const std::string& command, int exit, const std::string& words) {
  const Called c = faba_in(f.path, command);
  INFO(command, " -> ", c.exit, ": ", c.err);
  CHECK(c.exit == exit);
  CHECK(one_clear_line(c.err));
  CHECK(c.err.find(words) != std::string::npos);
  CHECK(c.out.empty());
}

/// As refused(), for a verb that reads a study with this text; it must not leave its directory behind.
inline void refused_study(const TestFolder& f, const std::string& verb, const std::string& study, int exit,
                          const std::string& words) {
  write_file(f.path / "refused.toml", study);
  INFO(study);
  refused(f, verb + " refused.toml --out refused", exit, words);
  CHECK(!std::filesystem::exists(f.path / "refused"));
}

}  // namespace faba
