#pragma once
#include <unistd.h>

#include <filesystem>
#include <string>

#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "core/file.h"

namespace faba {

/// A temporary folder of one test, removed by the destructor.
struct TestFolder {
  std::filesystem::path path;
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "faba-test-XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~TestFolder() { std::filesystem::remove_all(path); }
};

inline Scenario scenario_from(const std::string& toml) {
  return read_scenario(parse_toml(toml, "test.toml"), builtin_parts());
}

}  // namespace faba
