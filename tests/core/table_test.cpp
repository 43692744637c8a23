#include "core/table.h"

#include <doctest/doctest.h>

#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;

// More tests of tables: tests/study/data/series_test.cpp.
TEST_CASE("table: comments above the header; a last line without a line end is read") {
  const test::TemporaryFolder folder("table");
  const auto file = folder.path() / "t.csv";
  write_file(file, "# measured at noon\n# by hand\na,b\n1,2\n3,x");
  try {
    read_table(file);
    FAIL("a word was read as a number");
  } catch (const Error& e) {
    CHECK(e.where() == file.string() + ":5");
  }
  write_file(file, "# measured at noon\n# by hand\na,b\n1,2\n3,4");
  const Table kept = read_table(file), dropped = read_table(file, LastLine::drop);
  REQUIRE(kept.size() == 2);
  CHECK(kept.column("b")[1] == 4);
  CHECK_FALSE(kept.last_line_cut());
  CHECK(kept.location(1) == file.string() + ":5");
  CHECK(dropped.size() == 1);
  CHECK(dropped.last_line_cut());
}
