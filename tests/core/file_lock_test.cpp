#include "core/file_lock.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;

TEST_CASE("a held lock names the process and its host; complete() releases it") {
  const test::TemporaryFolder folder("lock");
  const auto file = folder.path() / "incomplete";
  char host[256] = {};
  REQUIRE(gethostname(host, sizeof host - 1) == 0);
  FileLock lock(file, folder.path(), "Resume it with: x\n");
  CHECK(read_file(file) == fmt::format("faba process {} on {}\nResume it with: x\n", getpid(), host));
  CHECK_THROWS_WITH(
      FileLock(file, folder.path(), ""),
      doctest::Contains(fmt::format("process {} on {} is writing to it", getpid(), host).c_str()));
  lock.complete();
  CHECK_NOTHROW(FileLock(file, folder.path(), ""));
}
