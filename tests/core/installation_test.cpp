// Paths of Faba's programs.
#include <doctest/doctest.h>

#include <filesystem>

#include "core/process/installation.h"

using namespace faba;

TEST_CASE("faba is this program, whatever its name; the others are beside it") {
  const auto self = std::filesystem::read_symlink("/proc/self/exe");
  REQUIRE(self.filename() != "faba");
  CHECK(program_file("faba") == self);
  CHECK(program_file("faba-coil-guard") == self.parent_path() / "faba-coil-guard");
  set_program_folder("/opt/faba");
  CHECK(program_file("faba") == "/opt/faba/faba");
  set_program_folder({});
}
