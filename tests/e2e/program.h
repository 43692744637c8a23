#pragma once
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/app/run_directory.h"

namespace faba {

/// Result of one call of the program.
struct Called {
  int exit = -1;
  std::string out, err;
  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

/// Runs `faba ARGUMENTS` in the shell, in `folder`; `before` comes before the program in the command line.
inline Called faba_in(const std::filesystem::path& folder, const std::string& arguments,
                      const std::string& before = "") {
  const auto err = folder / "stderr.txt";
  const std::string command = "cd '" + folder.string() + "' && " + before + " '" FABA_PROGRAM "' " +
                              arguments + " 2> '" + err.string() + "'";
  Called c;
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) c.out.append(buffer, n);
  const int status = pclose(pipe);
  c.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  c.err = read_file(err);
  return c;
}

/// The object that `faba ARGUMENTS --json` prints; the test case fails here if the program does.
inline nlohmann::json json_in(const std::filesystem::path& folder, const std::string& arguments) {
  const Called c = faba_in(folder, arguments + " --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  return c.json();
}

/// Whether `text` is a single line that starts with "faba: error: ".
inline bool one_clear_line(const std::string& text) {
  return text.starts_with("faba: error: ") && text.find('\n') == text.size() - 1;
}

inline const std::string kSmallScene =
    "duration = '2 s'\n[[swarm]]\ncount = 50\nmodel = 'basic'\n[arena]\ntype = 'box'\nsize_px = [160, 120]\n";

}  // namespace faba
